// The roles under which programs announce themselves.
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

// Whether a process of that role holds the rig, or the rigs of a limb, and sets the pace of a run.
inline bool IsPlant(const std::string& role) { return role == "plant" || role == "driver" || role == "limb"; }

}  // namespace hydro::process
