// What the page may ask of the stack. It may always stop it; the rest needs [scope] control = true. Each
// request runs on a thread of its own, so that nothing on the page waits for it.
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

// How a request ended, for the page. `data` is JSON, or empty.
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

class OperatorActions {
 public:
  // `post` runs work on the server's thread. `tunings` is by live run; nothing can be set in a run that has
  // none. Without `config` (a log is shown) there is no stack. For a limb, `config` is what its joints have
  // in common.
  OperatorActions(std::shared_ptr<const settings::StackConfig> config, bool control,
                  std::function<void(std::function<void()>)> post, std::map<uint32_t, Tuning*> tunings);
  ~OperatorActions();
  OperatorActions(const OperatorActions&) = delete;
  OperatorActions& operator=(const OperatorActions&) = delete;

  // Stops the stack as hydro-launch --stop does: every process that drives the motor is asked first. A stop
  // that is already under way answers all requests.
  void Stop(Done done);
  // Re-arms as hydro-launch --rearm does.
  void Rearm(Done done);
  // What re-arming would do now: a sentence, and the numbers in `data`.
  void ForecastRearm(Done done);
  void Set(uint32_t run, const std::vector<std::string>& entries, Done done);
  void Undo(uint32_t run, Done done);

  bool control() const { return control_; }
  const std::map<uint32_t, Tuning*>& tunings() const { return tunings_; }

 private:
  // A request of one kind. Only one thread at a time works on it.
  struct Errand {
    std::thread thread;
    std::vector<Done> waiting;
  };
  void Run(Errand* errand, Done done, std::function<launch::OperatorResult()> work);
  bool Refused(const Done& done) const;
  // Returns null after calling `done` when nothing can be set in that run.
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
