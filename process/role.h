// The role that a program announces itself under.
#pragma once

#include <algorithm>
#include <string>

namespace hydro::process {

// "pressure_ctrl" for "hydro-pressure-ctrl".
inline std::string RoleOf(const std::string& program) {
  std::string role = program.starts_with("hydro-") ? program.substr(6) : program;
  std::replace(role.begin(), role.end(), '-', '_');
  return role;
}

}  // namespace hydro::process
