// What the page may ask of the stack: to stop always, the rest where [scope] control = true. Each request runs on a thread of
// its own, so that nothing on the page waits for it.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "launch/logic/operator_request.h"
#include "settings/stack_config.h"

namespace hydro::scope {

// How a request ended, for the page. `data`: JSON, or empty.
struct Outcome {
  bool ok = false;
  std::string text;
  std::string data;
};
using Done = std::function<void(const Outcome&)>;

// Changes of gains and references while the stack runs.
class Tuning {
 public:
  virtual ~Tuning() = default;
  // Calls `done` once, on the server's thread.
  virtual void Set(const std::vector<std::string>& entries, Done done) = 0;
  virtual void Undo(Done done) = 0;
  // The message "tuning" with the values in force; empty: not known.
  virtual const std::string& message() const = 0;
};

class OperatorDesk {
 public:
  // `post` runs work on the server's thread. `tunings`: by live run; of one that has none nothing can be set. Without `config` (a log is
  // shown) there is no stack. Of a limb it is what its joints have in common.
  OperatorDesk(std::shared_ptr<const settings::StackConfig> config, bool control,
               std::function<void(std::function<void()>)> post, std::map<uint32_t, Tuning*> tunings);
  ~OperatorDesk();
  OperatorDesk(const OperatorDesk&) = delete;
  OperatorDesk& operator=(const OperatorDesk&) = delete;

  // As hydro-launch --stop: every process that drives the motor is asked first. A stop that is under way answers all who ask.
  void Stop(Done done);
  // As hydro-launch --rearm.
  void Rearm(Done done);
  // What that would do now: a sentence, and as `data` the numbers.
  void ForecastRearm(Done done);
  void Set(uint32_t run, const std::vector<std::string>& entries, Done done);
  void Undo(uint32_t run, Done done);

  bool control() const { return control_; }
  const std::map<uint32_t, Tuning*>& tunings() const { return tunings_; }

 private:
  // A request of one kind: one thread at a time.
  struct Errand {
    std::thread thread;
    std::vector<Done> waiting;
  };
  void Run(Errand* errand, Done done, std::function<launch::OperatorResult()> work);
  bool Refused(const Done& done) const;
  // Null: nothing can be set of that run, and `done` has been told.
  Tuning* TuningOf(uint32_t run, const Done& done) const;

  std::shared_ptr<const settings::StackConfig> config_;
  bool control_;
  std::function<void(std::function<void()>)> post_;
  std::map<uint32_t, Tuning*> tunings_;
  Errand stop_;
  Errand rearm_;
  Errand forecast_;
};

}  // namespace hydro::scope
