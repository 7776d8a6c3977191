// What a process states about itself in HYDRO_PROCESS_STATUS.
#pragma once

#include <cstdint>
#include <hydro/process_status_t.hpp>
#include <string>

namespace hydro::process {

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
