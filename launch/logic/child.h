// A process that a launch starts: what it is, and how it ended.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace hydro::launch {

struct ChildSpec {
  std::string label;              // precedes each of its lines, e.g. plant
  std::vector<std::string> argv;  // argv[0] is the path of the program
  bool last = false;              // is stopped only when all processes without this mark have ended

  std::string program() const;  // the last part of the path, e.g. hydro-plant
};

// How a process ended: with exit_code, or by a signal (then signal != 0).
struct ProcessEnd {
  int exit_code = 0;
  int signal = 0;
};

// A child that has ended, as a launch learns of it.
struct Ended {
  std::string label;
  std::string program;
  int32_t pid = -1;
  ProcessEnd end;
  bool terminated = false;  // the stop had sent it SIGTERM
  bool hung = false;        // it did not end on SIGTERM and was sent SIGKILL
};

// "hydro-plant was killed by signal 9 (SIGKILL)", "hydro-plant ended with exit code 1"
std::string DescribeEnd(const std::string& program, const ProcessEnd& end);

// The program could not be started; what() is one line.
class StartError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace hydro::launch
