// One process that we started: its two output pipes, its end.
#pragma once

#include <sys/types.h>

#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace hydro::launch {

struct ChildSpec {
  std::string label;              // before each of its lines, e.g. plant
  std::vector<std::string> argv;  // argv[0] is the path of the program
  bool last = false;              // is stopped only when all that are not last have ended

  std::string program() const;  // the path's last part, e.g. hydro-plant
};

// How a process ended: by itself with exit_code, or by a signal (then signal != 0).
struct ProcessEnd {
  int exit_code = 0;
  int signal = 0;
};

// "hydro-plant was killed by signal 9 (SIGKILL)", "hydro-plant ended with exit code 1"
std::string DescribeEnd(const std::string& program, const ProcessEnd& end);

// The program could not be started; what() is one line.
class StartError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

// Owns a started process until it has been reaped. Because nobody else reaps it, its pid cannot be given to
// another process before TryReap() has succeeded, and Signal() can reach only this one.
class ChildProcess {
 public:
  // Starts the program in a process group of its own (a terminal's Ctrl-C does not reach it), with stdin from
  // /dev/null, all signals unblocked, and SIGTERM on our death, however we die. SIGPIPE is ignored in it:
  // when we are gone, a line that it prints on its way out must not kill it before it has flushed. Throws
  // StartError.
  explicit ChildProcess(ChildSpec spec);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  const ChildSpec& spec() const { return spec_; }
  pid_t pid() const { return pid_; }
  bool running() const { return !end_; }
  const std::optional<ProcessEnd>& end() const { return end_; }

  // Reads its end, if it has ended. True when this call found it.
  bool TryReap();

  // Sends a signal, unless it has been reaped.
  void Signal(int signal_number);

  // Our ends of its stdout and stderr, non-blocking; -1 once closed.
  int out_fd() const { return out_fd_; }
  int err_fd() const { return err_fd_; }
  void CloseOut();
  void CloseErr();

 private:
  ChildSpec spec_;
  pid_t pid_ = -1;
  int out_fd_ = -1;
  int err_fd_ = -1;
  std::optional<ProcessEnd> end_;
};

}  // namespace hydro::launch
