#include "process/process_end.h"

#include <string.h>
#include <sys/wait.h>

namespace hydro::process {

ProcessEnd EndOf(int wait_status) {
  return WIFSIGNALED(wait_status) ? ProcessEnd{0, WTERMSIG(wait_status)}
                                  : ProcessEnd{WEXITSTATUS(wait_status), 0};
}

std::string DescribeEnd(const std::string& program, const ProcessEnd& end) {
  if (end.signal == 0) return program + " ended with exit code " + std::to_string(end.exit_code);
  std::string text = program + " was killed by signal " + std::to_string(end.signal);
  if (const char* name = sigabbrev_np(end.signal)) text += std::string(" (SIG") + name + ")";
  return text;
}

}  // namespace hydro::process
