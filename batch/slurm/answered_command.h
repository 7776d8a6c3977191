// Runs a command and returns what it prints.
#pragma once

#include <chrono>
#include <functional>
#include <string>
#include <vector>

namespace hydro::batch {

struct Answer {
  bool ended_itself = false;  // false: it was late, `stop` was true, or a signal ended it
  int exit_code = -1;
  std::string out, err;
};

// The path of a program in $PATH; empty when there is none.
std::string ProgramInPath(const std::string& name);

// `argv[0]` is the path of the program. The command is ended after `limit`, or when `stop` is true. Throws
// process::StartError, std::runtime_error.
Answer AskCommand(const std::vector<std::string>& argv, std::chrono::seconds limit,
                  const std::function<bool()>& stop);

}  // namespace hydro::batch
