// What a process states about itself: its role, and its state in HYDRO_PROCESS_STATUS.
#pragma once

#include <algorithm>
#include <cstdint>
#include <hydro/process_status_t.hpp>
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

// "plant on rig (process 4711)".
inline std::string ProcessName(const std::string& role, const std::string& host, int64_t pid) {
  return role + " on " + host + " (process " + std::to_string(pid) + ")";
}
inline std::string ProcessName(const process_status_t& status) {
  return ProcessName(status.role, status.host, status.pid);
}

// Whether the process takes part, or will.
inline bool IsThere(const process_status_t& status) {
  return status.state == process_status_t::READY || status.state == process_status_t::RUNNING;
}
// Whether the process sends nothing more.
inline bool HasLeft(const process_status_t& status) {
  return status.state == process_status_t::DONE || status.state == process_status_t::FAILED;
}

}  // namespace hydro::process
