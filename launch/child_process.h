// A process that the launcher has started, with the lines of its two output pipes and the way in which it
// ended.
#pragma once

#include <sys/types.h>

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "launch/logic/children.h"
#include "launch/logic/stop_sequence.h"

namespace hydro::launch {

// Cuts the bytes that a pipe delivers into lines.
class LineAssembler {
 public:
  using LineHandler = std::function<void(std::string_view line)>;  // without its line end

  // A longer line is passed on in pieces, so that a program that never ends a line cannot fill the memory.
  static constexpr std::size_t kLongestLine = 64 * 1024;

  // Adds bytes and calls `handler` for each line that they complete.
  void Feed(std::string_view bytes, const LineHandler& handler);

  // Call it when the pipe has ended: an unfinished line counts as a line.
  void Finish(const LineHandler& handler);

 private:
  std::string unfinished_;
};

// Owns a started process until it has been reaped. Nothing else reaps the process, so its pid cannot be
// reused before TryReap() has succeeded, and Signal() can reach no other process.
class ChildProcess : public Stoppable {
 public:
  // Starts the program (process/spawn.h). One of our programs, or a driver, has a socket for Beat() as its
  // stdin. Throws StartError.
  explicit ChildProcess(ChildSpec spec);
  ~ChildProcess() override;
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  const ChildSpec& spec() const { return spec_; }
  pid_t pid() const { return pid_; }
  bool running() const override { return !end_; }
  bool last() const override { return spec_.last; }
  const std::optional<ProcessEnd>& end() const { return end_; }
  // What the system refused to the process, one line each.
  const std::vector<std::string>& warnings() const { return warnings_; }

  // Checks whether the process has ended. Returns true when this call is the first to find that it has. It
  // then also kills what a program of the user's own has started: a loop must not go on unwatched.
  bool TryReap();

  // Sends a heartbeat (process/stop_signal.h). Never waits; what the program does not read is lost.
  void Beat();

  // Sends a signal to the process unless it has been reaped; for a program of the user's own, also to all
  // processes that it started.
  void Signal(int signal_number) override;

  // The launcher's ends of its stdout and stderr, non-blocking; -1 once closed.
  int out_fd() const { return out_fd_; }
  int err_fd() const { return err_fd_; }
  void CloseOut();
  void CloseErr();

 private:
  ChildSpec spec_;
  pid_t pid_ = -1;
  std::vector<std::string> warnings_;
  int beat_fd_ = -1;
  int out_fd_ = -1;
  int err_fd_ = -1;
  std::optional<ProcessEnd> end_;
};

}  // namespace hydro::launch
