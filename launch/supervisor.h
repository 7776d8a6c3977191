// Starts processes that belong together and ends them together. It knows neither the bus nor what the
// programs do.
#pragma once

#include <chrono>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "launch/child_process.h"
#include "launch/labelled_output.h"
#include "launch/line_assembler.h"

namespace hydro::launch {

// Contract:
// - Every line that a child printed is passed to the output before its end is reported.
// - Stop() sends SIGTERM to the children that are not `last`, then to the `last` ones when the others have
//   ended, and SIGKILL to any child that has not ended within its grace period. Only processes that this
//   object started are ever signalled.
// - The destructor does the same and waits, so that no way out leaves a child behind.
class Supervisor {
 public:
  using Clock = std::chrono::steady_clock;
  using TimePoint = Clock::time_point;
  using Duration = Clock::duration;

  struct Grace {
    Duration child = std::chrono::seconds(3);  // from SIGTERM to SIGKILL
    Duration last =
        std::chrono::seconds(10);  // the same for `last` children: a logger may have much to write
    Duration before_last{};        // from the end of the others to the SIGTERM for the `last` ones
  };

  struct Ended {
    std::string label;
    std::string program;
    pid_t pid = -1;
    ProcessEnd end;
    bool terminated = false;  // Stop() had sent it SIGTERM
    bool hung = false;        // it did not end on SIGTERM and was sent SIGKILL
  };

  // Blocks SIGINT, SIGTERM and SIGHUP in this thread from now on; NextSignal() returns them. Create it before
  // any other thread, so that those inherit the mask.
  Supervisor(LabelledOutput& output, Grace grace);
  ~Supervisor();
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  // Starts a process and returns its pid. Throws StartError.
  pid_t Start(ChildSpec spec);

  // Waits until a child prints or ends, a signal comes, or `deadline`. Passes output on and takes the steps
  // of a stop that are due. Sends each child a heartbeat, so call it often: without one a plant goes to zero volts
  // (limits.stale_supervisor_s).
  void Wait(TimePoint deadline);

  // What Wait() found, oldest first; nothing when there is no more.
  std::optional<Ended> NextEnded();
  std::optional<int> NextSignal();

  // Begins the stop. SIGTERM goes out at `first_signal`, which leaves children that are about to end by
  // themselves time to do so. A later call can only bring it forward.
  void Stop(TimePoint first_signal);
  bool stopping() const { return stop_at_.has_value(); }

  // Sends SIGKILL to all children that have not ended.
  void KillAll();

  int running() const;        // children that have not ended
  int running_first() const;  // those of them that are not `last`
  // No child is left and all their lines have been written.
  bool finished() const { return running() == 0 && output_.waiting_fd() < 0; }

 private:
  struct Child {
    explicit Child(ChildSpec spec) : process(std::move(spec)) {}
    ChildProcess process;
    LineAssembler out_lines;
    LineAssembler err_lines;
    std::optional<TimePoint> terminated_at;
    bool hung = false;
  };

  void Read(Child& child, LabelledOutput::Stream stream);
  void ReadRest(Child& child, LabelledOutput::Stream stream);
  void Reap();
  void TakeStopSteps(TimePoint now);
  TimePoint NextStopStep() const;
  Duration GraceOf(const Child& child) const;
  void ReadSignals();

  LabelledOutput& output_;
  Grace grace_;
  int signal_fd_ = -1;
  std::vector<std::unique_ptr<Child>> children_;
  std::deque<Ended> ended_;
  std::deque<int> signals_;
  std::optional<TimePoint> stop_at_;
  std::optional<TimePoint> first_gone_at_;  // during a stop: when only the `last` children were left
};

}  // namespace hydro::launch
