// Starts processes that belong together and ends them together. It knows neither the bus nor what the
// programs do.
#pragma once

#include <chrono>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "launch/child_process.h"
#include "launch/labelled_output.h"
#include "launch/logic/children.h"

namespace hydro::launch {

// Contract, beyond launch/logic/children.h:
// - Every line that a child printed is passed to the output before its end is reported.
// - Only processes that this object started are ever signalled.
// - The destructor stops them all and waits, so that no way out leaves a child behind.
class Supervisor : public Children {
 public:
  using Clock = std::chrono::steady_clock;

  // From now on blocks SIGINT, SIGTERM and SIGHUP in this thread; NextSignal() returns them. Create it before
  // any other thread, so that the other threads inherit the mask.
  Supervisor(LabelledOutput& output, Grace grace);
  ~Supervisor() override;
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  int32_t Start(const ChildSpec& spec) override;
  // Also passes on what the children print.
  void Wait(TimePoint deadline) override;
  std::optional<Ended> NextEnded() override;
  std::optional<int> NextSignal() override;
  void Stop(TimePoint first_signal) override { stop_.Begin(first_signal); }
  bool stopping() const override { return stop_.begun(); }
  void KillAll() override;
  int running() const override { return stop_.running(); }
  size_t unread() const override { return output_.unread(); }

 private:
  struct Child {
    explicit Child(const ChildSpec& spec) : process(spec) {}
    ChildProcess process;
    LineAssembler out_lines;
    LineAssembler err_lines;
  };

  void Read(Child& child, LabelledOutput::Stream stream);
  void ReadRest(Child& child, LabelledOutput::Stream stream);
  void Reap();
  void ReadSignals();

  LabelledOutput& output_;
  int signal_fd_ = -1;
  std::vector<std::unique_ptr<Child>> children_;
  StopSequence stop_;
  std::deque<Ended> ended_;
  std::deque<int> signals_;
};

}  // namespace hydro::launch
