#include "plant/roll_call.h"

#include <algorithm>

#include "process/status.h"

namespace hydro::plant {
namespace {

// A stack has five processes; more would come from a flood of made-up ones.
constexpr size_t kMostPresent = 256;

}  // namespace

void RollCall::Observe(const process_status_t& status) {
  const std::pair key(status.role, status.session);  // on a simulated clock every session is 0
  const bool matters = status.role == "logger" ||
                       std::find(expected_.begin(), expected_.end(), status.role) != expected_.end();
  if (!matters) return;
  if (process::IsThere(status)) {
    if (present_.size() < kMostPresent || present_.contains(key)) present_[key] = status;
    return;
  }
  const auto found = present_.find(key);
  if (found == present_.end()) return;  // it took no part in this run
  present_.erase(found);
  if (left_.empty()) {
    left_ = process::ProcessName(status);
    if (!status.text.empty()) left_ += ": " + status.text;
  }
}

std::vector<std::string> RollCall::Missing() const {
  std::vector<std::string> missing;
  for (const std::string& role : expected_) {
    const bool present = std::any_of(present_.begin(), present_.end(),
                                     [&](const auto& entry) { return entry.second.role == role; });
    if (!present) missing.push_back(role);
  }
  return missing;
}

std::vector<int64_t> RollCall::Participants() const {
  std::vector<int64_t> sessions = Loggers();
  for (const auto& [key, status] : present_) {
    if (std::find(expected_.begin(), expected_.end(), status.role) != expected_.end()) {
      sessions.push_back(status.session);
    }
  }
  return sessions;
}

std::vector<int64_t> RollCall::Loggers() const {
  std::vector<int64_t> sessions;
  for (const auto& [key, status] : present_) {
    if (status.role == "logger") sessions.push_back(status.session);
  }
  return sessions;
}

}  // namespace hydro::plant
