#include "launch/logic/stack_watch.h"

#include <algorithm>

#include "bus/session.h"
#include "process/participant.h"
#include "process/role.h"
#include "process/status.h"

namespace hydro::launch {
namespace {

constexpr size_t kMostStatuses = 256;  // a stack has five processes; a flood of made-up ones is not kept

}  // namespace

StackWatch::StackWatch(bus::Bus& bus, const bus::Clock& clock, const bus::Channels& channels, bool spread,
                       bool keep_timing)
    : bus_(bus), clock_(clock), channels_(channels), spread_(spread), identity_(bus::IdentityOn(bus, clock)) {
  bus.Subscribe<process_status_t>(channels_.Of<process_status_t>(), [this](const process_status_t& status) {
    const std::pair key(status.role, status.pid);
    if (status.session == identity_.session) return;
    if (statuses_.size() < kMostStatuses || statuses_.contains(key)) statuses_[key] = status;
  });
  bus.Subscribe<stop_t>(channels_.Of<stop_t>(), [this](const stop_t& stop) {
    if (!stop_ && stop.session != identity_.session && IsForThisStack(stop)) stop_ = stop;
  });
  bus.Subscribe<loop_statistics_t>(channels_.Of<loop_statistics_t>(),
                                   [this, keep_timing](const loop_statistics_t& report) {
                                     summary_.Add(report);
                                     if (keep_timing) timing_.Add(report);
                                   });
  if (keep_timing) {
    bus.Subscribe<loop_histogram_t>(channels_.Of<loop_histogram_t>(),
                                    [this](const loop_histogram_t& histogram) { timing_.Add(histogram); });
  }
  bus.Subscribe<fault_t>(channels_.Of<fault_t>(), [this](const fault_t& fault) { summary_.Add(fault); });
  bus.Subscribe<output_left_t>(channels_.Of<output_left_t>(), [this](const output_left_t& left) {
    if (IsOfAPlant(left.session)) summary_.Add(left);
  });
}

bool StackWatch::IsOfAPlant(int64_t session) const {
  return std::any_of(statuses_.begin(), statuses_.end(), [&](const auto& entry) {
    const auto& [role, status] = entry;
    return process::IsPlant(role.first) && status.session == session;
  });
}

void StackWatch::Expect(const ChildSpec& child, int32_t pid) {
  expected_.push_back({child.program(), child.role(), pid, child.own.has_value()});
}

bool StackWatch::Is(const Expected& expected, const process_status_t& status) {
  return status.role == expected.role && (expected.own || status.pid == expected.pid);
}

const process_status_t* StackWatch::StatusOf(const Expected& expected) const {
  const process_status_t* newest = nullptr;
  for (const auto& [key, status] : statuses_) {
    if (Is(expected, status) && (newest == nullptr || status.utime > newest->utime)) newest = &status;
  }
  return newest;
}

std::vector<std::string> StackWatch::NotReady() const {
  std::vector<std::string> missing;
  for (const Expected& expected : expected_) {
    const process_status_t* status = StatusOf(expected);
    if (status == nullptr || status->state == process_status_t::FAILED) {
      missing.push_back(expected.program);
    }
  }
  return missing;
}

std::string StackWatch::FailureText(const std::string& program, int32_t pid) const {
  for (const Expected& expected : expected_) {
    if (expected.program != program || expected.pid != pid) continue;
    const process_status_t* status = StatusOf(expected);
    if (status != nullptr && status->state == process_status_t::FAILED) return status->text;
  }
  return "";
}

void StackWatch::AskWhoIsThere() {
  process_status_t question;
  question.utime = clock_.Utime();
  question.session = identity_.session;
  question.role = process::kLaunchRole;
  question.host = identity_.host;
  question.version = HYDRO_VERSION;
  question.pid = identity_.id;
  question.state = process_status_t::READY;
  question.text = "asks who is there";
  bus_.Publish(channels_.Of<process_status_t>(), question);
}

std::vector<std::string> StackWatch::Present(const std::vector<std::string>& roles) const {
  std::vector<std::string> names;
  for (const auto& [key, status] : statuses_) {
    if (process::HasLeft(status) || std::find(roles.begin(), roles.end(), status.role) == roles.end())
      continue;
    names.push_back(process::ProcessName(status));
  }
  return names;
}

bool StackWatch::BelongsHere(const process_status_t& status) const {
  if (spread_) return true;
  return std::any_of(expected_.begin(), expected_.end(),
                     [&](const Expected& expected) { return Is(expected, status); });
}

bool StackWatch::IsForThisStack(const stop_t& stop) const {
  if (stop.addressee == 0) return true;
  return std::any_of(statuses_.begin(), statuses_.end(), [&](const auto& entry) {
    return entry.second.session == stop.addressee && BelongsHere(entry.second);
  });
}

// The plant, which stands for its run; while none has been heard, each process by itself.
std::vector<int64_t> StackWatch::Addressees() const {
  std::vector<int64_t> all;
  for (const auto& [key, status] : statuses_) {
    if (!BelongsHere(status) || process::HasLeft(status)) continue;
    if (process::IsPlant(status.role)) return {status.session};
    all.push_back(status.session);
  }
  return all;
}

void StackWatch::PublishStop(const std::string& reason, int exit_code) {
  stop_t stop;
  stop.utime = clock_.Utime();
  stop.tick = -1;
  stop.session = identity_.session;
  stop.source = "launch";
  stop.reason = reason;
  stop.exit_code = exit_code;
  for (const int64_t addressee : Addressees()) {
    stop.addressee = addressee;
    bus_.Publish(channels_.Of<stop_t>(), stop);
  }
}

}  // namespace hydro::launch
