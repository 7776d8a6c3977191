#include "process/remote_faults.h"

#include <algorithm>
#include <sstream>

namespace hydro::process {
namespace {

constexpr size_t kMost = 64;  // a stack has fewer; more would come from a flood of made-up faults

}  // namespace

void RemoteFaults::Observe(const fault_t& fault, bus::Clock::TimePoint now) {
  if (!counts_(fault.source, fault.code)) return;
  const std::pair key(fault.session, fault.code);
  if (fault.active == 0) {
    faults_.erase(key);
    return;
  }
  // The new fault replaces the one heard longest ago. A fault that its sender lists again is soon back, and
  // until then the others count.
  if (faults_.size() >= kMost && !faults_.contains(key)) {
    faults_.erase(std::min_element(faults_.begin(), faults_.end(),
                                   [](const auto& a, const auto& b) { return a.second.at < b.second.at; }));
  }
  faults_.emplace(key, Heard{fault, now});
}

// A fault that its sender no longer lists is over, and one that it lists is present, even if the message that
// announced the change was lost.
void RemoteFaults::Observe(const active_faults_t& active, bus::Clock::TimePoint now) {
  std::erase_if(faults_, [&](const auto& entry) {
    const std::string& code = entry.first.second;
    return entry.first.first == active.session &&
           (" " + active.codes + " ").find(" " + code + " ") == std::string::npos;
  });
  std::istringstream codes(active.codes);
  for (std::string code; codes >> code;) {
    if (const auto known = faults_.find({active.session, code}); known != faults_.end()) {
      known->second.at = now;
      continue;
    }
    fault_t fault{};
    fault.session = active.session;
    fault.source = active.role;
    fault.code = code;
    fault.text = "it lasts";
    fault.active = true;
    Observe(fault, now);
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

// A fault of a process that never existed (wrong bits) or is silent must not last for ever.
bool RemoteFaults::any(bus::Clock::TimePoint now) {
  if (faults_.empty()) return false;
  std::erase_if(faults_, [&](const auto& entry) { return now - entry.second.at > kAlive; });
  return !faults_.empty();
}

}  // namespace hydro::process
