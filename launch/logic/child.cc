#include "launch/logic/child.h"

#include "process/role.h"

namespace hydro::launch {

std::string ChildSpec::program() const {
  if (own) return own->name;
  const std::string& path = argv.at(0);
  return path.substr(path.rfind('/') + 1);  // npos + 1 is 0
}

std::string ChildSpec::role() const { return own ? own->role : process::RoleOf(program()); }

}  // namespace hydro::launch
