// Stops the processes of a stack that run on this machine, without the network (process/stop_socket.h).
#pragma once

#include <chrono>
#include <string>
#include <vector>

#include "launch/logic/operator_request.h"
#include "settings/stack_config.h"

namespace hydro::launch {

class LocalStop : public LocalProcesses {
 public:
  using Duration = std::chrono::steady_clock::duration;

  // Finds the processes of the stack.
  LocalStop(const settings::StackConfig& config, const Asker& asker);
  ~LocalStop() override;
  LocalStop(const LocalStop&) = delete;
  LocalStop& operator=(const LocalStop&) = delete;

  // Asks the process that drives the motor (plant or driver) to stop; the others usually hear of that over
  // the bus.
  void StopMotor();

  // Asks all processes that are left, the logger last, and waits until they have ended, for at most
  // `patience`.
  void StopRest(Duration patience);

  int found() const override { return static_cast<int>(processes_.size()); }
  bool Found(int pid) const override;

  std::string Left() override;

 private:
  struct Process {
    std::string role;
    int pid = 0;
    int connection = -1;
    bool asked = false;
    bool deaf = false;     // does not accept our connection: the process is stopped, or hangs
    bool refused = false;  // it belongs to another user
    bool ended = false;
  };
  void Connect(const std::string& prefix);
  void Ask(Process& process);
  bool AllEnded(bool with_loggers);
  void AwaitEnd(bool with_loggers, Duration patience);

  std::string request_;
  std::vector<Process> processes_;
};

}  // namespace hydro::launch
