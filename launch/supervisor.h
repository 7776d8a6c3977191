// Processes that were started together and end together. Knows nothing of the bus or of what the programs
// are.
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
// - Stop() sends SIGTERM to the children that are not `last`; to the others when those have ended; SIGKILL to
//   each that is still there a while after its SIGTERM. Only processes that this object started are ever
//   signalled.
// - The destructor does the same and waits for it, so that no way out leaves a child behind.
class Supervisor {
 public:
  using Clock = std::chrono::steady_clock;
  using TimePoint = Clock::time_point;
  using Duration = Clock::duration;

  struct Grace {
    Duration child = std::chrono::seconds(3);  // from SIGTERM to SIGKILL
    Duration last = std::chrono::seconds(10);  // the same for `last` ones: a logger may have much to write
    Duration before_last{};                    // from the end of the others to the SIGTERM of the `last` ones
  };

  struct Ended {
    std::string label;
    std::string program;
    pid_t pid = -1;
    ProcessEnd end;
    bool told_to_end = false;  // we had sent it SIGTERM
    bool hung = false;         // we had to send it SIGKILL because it did not end on SIGTERM
  };

  // From here on SIGINT, SIGTERM and SIGHUP are blocked in this thread and come out of NextSignal(). Create
  // it before any other thread, so that those inherit the mask.
  Supervisor(LabelledOutput& output, Grace grace);
  ~Supervisor();
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  // Starts a process and returns its pid. Throws StartError.
  pid_t Start(ChildSpec spec);

  // Waits until a child printed or ended, a signal came, or `deadline`; passes output on, and takes the steps
  // of the stop that are due.
  void Wait(TimePoint deadline);

  // What Wait() found, oldest first; empty when there is no more.
  std::optional<Ended> NextEnded();
  std::optional<int> NextSignal();

  // Begins the stop: SIGTERM at `first_signal`, so that those that are about to end by themselves may. A
  // second call can only make it sooner.
  void Stop(TimePoint first_signal);
  bool stopping() const { return stop_at_.has_value(); }

  // SIGKILL to all that are left.
  void KillAll();

  // Children that are neither ended nor `last`; all that have not ended.
  int running_first() const;
  int running() const;
  // No child is left and all their lines have been written.
  bool finished() const { return running() == 0 && output_.waiting_fd() < 0; }

 private:
  struct Child {
    explicit Child(ChildSpec spec) : process(std::move(spec)) {}
    ChildProcess process;
    LineAssembler out_lines;
    LineAssembler err_lines;
    std::optional<TimePoint> told_at;
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
  std::optional<TimePoint> first_gone_at_;  // when, during a stop, no child was left but the `last` ones
};

}  // namespace hydro::launch
