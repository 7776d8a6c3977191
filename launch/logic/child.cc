#include "launch/logic/child.h"

#include <string.h>

#include "process/role.h"

namespace hydro::launch {

std::string ChildSpec::program() const {
  if (own) return own->name;
  const std::string& path = argv.at(0);
  return path.substr(path.rfind('/') + 1);  // npos + 1 is 0
}

std::string ChildSpec::role() const { return own ? own->role : process::RoleOf(program()); }

std::string DescribeEnd(const std::string& program, const ProcessEnd& end) {
  if (end.signal == 0) return program + " ended with exit code " + std::to_string(end.exit_code);
  std::string text = program + " was killed by signal " + std::to_string(end.signal);
  if (const char* name = sigabbrev_np(end.signal)) text += std::string(" (SIG") + name + ")";
  return text;
}

}  // namespace hydro::launch
