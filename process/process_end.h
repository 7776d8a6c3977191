// How a child process ended, or why it did not start.
#pragma once

#include <stdexcept>
#include <string>

namespace hydro::process {

// Holds the exit_code, or the signal that ended the process (then signal != 0).
struct ProcessEnd {
  int exit_code = 0;
  int signal = 0;
};

// Translates what waitpid() reports about a process that has ended.
ProcessEnd EndOf(int wait_status);

// "hydro-plant was killed by signal 9 (SIGKILL)", "hydro-plant ended with exit code 1"
std::string DescribeEnd(const std::string& program, const ProcessEnd& end);

// Thrown when the program could not be started; what() is one line.
class StartError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace hydro::process
