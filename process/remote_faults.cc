#include "process/remote_faults.h"

namespace hydro::process {
namespace {

constexpr size_t kMost = 64;  // a stack has fewer; a flood of made-up ones is not kept

}  // namespace

void RemoteFaults::Observe(const fault_t& fault, bus::Clock::TimePoint now) {
  const std::pair key(fault.session, fault.code);
  if (fault.active == 0) {
    faults_.erase(key);
  } else if (faults_.size() < kMost) {
    faults_.emplace(key, Heard{fault, now});
  }
}

// What its sender no longer has is gone, though the message that said so may be lost.
void RemoteFaults::Observe(const active_faults_t& active, bus::Clock::TimePoint now) {
  const std::string codes = " " + active.codes + " ";
  for (auto entry = faults_.begin(); entry != faults_.end();) {
    const auto& [session, code] = entry->first;
    if (session != active.session) {
      ++entry;
    } else if (codes.find(" " + code + " ") != std::string::npos) {
      entry++->second.at = now;
    } else {
      entry = faults_.erase(entry);
    }
  }
}

void RemoteFaults::ForgetSession(int64_t session) {
  std::erase_if(faults_, [&](const auto& entry) { return entry.first.first == session; });
}

void RemoteFaults::ForgetOthersOfRole(const std::string& role, int64_t session) {
  std::erase_if(faults_, [&](const auto& entry) {
    return entry.first.first != session && entry.second.fault.source == role;
  });
}

// A fault of a process that never was (wrong bits) or is silent must not last for ever.
bool RemoteFaults::any(bus::Clock::TimePoint now) {
  if (faults_.empty()) return false;
  std::erase_if(faults_, [&](const auto& entry) { return now - entry.second.at > kAlive; });
  return !faults_.empty();
}

}  // namespace hydro::process
