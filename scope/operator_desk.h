// What the page may ask of the stack: to stop always, the rest where [scope] control = true. Each request runs on a thread of
// its own, so that nothing on the page waits for it.
#pragma once

#include <functional>
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
  // `post` runs work on the server's thread. `tuning` may be null: then nothing can be set. Without `config` (a log is shown) there is
  // no stack.
  OperatorDesk(std::shared_ptr<const settings::StackConfig> config, bool control,
               std::function<void(std::function<void()>)> post, Tuning* tuning);
  ~OperatorDesk();
  OperatorDesk(const OperatorDesk&) = delete;
  OperatorDesk& operator=(const OperatorDesk&) = delete;

  // As hydro-launch --stop: every process that drives the motor is asked first. A stop that is under way answers all who ask.
  void Stop(Done done);
  // As hydro-launch --rearm.
  void Rearm(Done done);
  void Set(const std::vector<std::string>& entries, Done done);
  void Undo(Done done);

  bool control() const { return control_; }
  const Tuning* tuning() const { return tuning_; }  // null: none

 private:
  // A request of one kind: one thread at a time.
  struct Errand {
    std::thread thread;
    std::vector<Done> waiting;
  };
  void Run(Errand* errand, Done done, std::function<launch::OperatorResult()> work);
  bool Refused(const Done& done) const;

  std::shared_ptr<const settings::StackConfig> config_;
  bool control_;
  std::function<void(std::function<void()>)> post_;
  Tuning* tuning_;
  Errand stop_;
  Errand rearm_;
};

}  // namespace hydro::scope
