#include "launch/logic/stack_watch.h"

#include <algorithm>

#include "bus/session.h"
#include "process/participant.h"
#include "process/status.h"

namespace hydro::launch {
namespace {

// A stack has five processes, and so has each joint; more would come from a flood of made-up ones.
constexpr size_t kMostStatuses = 256;
constexpr size_t kMostStatusesOfAJoint = 8;

}  // namespace

StackWatch::StackWatch(bus::Bus& bus, const bus::Clock& clock, const settings::StackConfig& config,
                       bool spread, bool keep_timing)
    : bus_(bus),
      clock_(clock),
      spread_(spread),
      joints_concern_each_other_(config.joints_concern_each_other),
      identity_(bus::IdentityOn(bus, clock)) {
  stacks_.push_back({"", bus::Channels(config.bus.channel_suffix)});
  for (size_t i = 0; i < config.joints.size(); ++i) {
    const std::string& joint = config.joints[i];
    const bool own_processes = std::ranges::find(config.processes, joint, &settings::ProcessSection::joint) !=
                               config.processes.end();
    stacks_.push_back({joint, bus::Channels(config.bus.joint_suffixes.at(i)), own_processes});
  }
  for (size_t i = 0; i < stacks_.size(); ++i) Listen(i, keep_timing);
}

void StackWatch::Listen(size_t stack, bool keep_timing) {
  const bus::Channels& channels = stacks_[stack].channels;
  const std::string& joint = stacks_[stack].joint;
  bus_.Subscribe<process_status_t>(
      channels.Of<process_status_t>(), [this, stack](const process_status_t& status) {
        const Key key(stack, status.role, status.pid);
        if (status.session == identity_.session) return;
        const size_t most = kMostStatuses + stacks_.size() * kMostStatusesOfAJoint;
        if (statuses_.size() < most || statuses_.contains(key)) statuses_[key] = {stack, status};
      });
  bus_.Subscribe<stop_t>(channels.Of<stop_t>(), [this, joint](const stop_t& stop) {
    // In lockstep the joints inside a limb have no session; the limb states why it ends.
    const bool inside_a_limb = !joint.empty() && stop.session == 0 && process::IsPlant(stop.source);
    const bool of_one_joint = !joint.empty() || (stop.source == "limb" && stop.addressee != 0);
    if (of_one_joint && !joints_concern_each_other_ && stop.exit_code != 0) return;  // the others go on
    if (!stop_ && !inside_a_limb && stop.session != identity_.session && IsForThisStack(stop)) stop_ = stop;
  });
  bus_.Subscribe<fault_t>(channels.Of<fault_t>(), [this, joint](const fault_t& heard) {
    fault_t fault = heard;
    fault.source = Named(joint, heard.source);
    summary_.Add(fault);
  });
  bus_.Subscribe<output_left_t>(channels.Of<output_left_t>(), [this, joint](const output_left_t& heard) {
    output_left_t left = heard;
    left.role = Named(joint, heard.role);
    if (IsOfAPlant(heard.session)) summary_.Add(left);
  });
  if (!stacks_[stack].reports) return;
  bus_.Subscribe<loop_statistics_t>(channels.Of<loop_statistics_t>(),
                                    [this, keep_timing, joint](const loop_statistics_t& heard) {
                                      loop_statistics_t report = heard;
                                      report.role = Named(joint, heard.role);
                                      summary_.Add(report);
                                      if (keep_timing) timing_.Add(report);
                                    });
  if (!keep_timing) return;
  bus_.Subscribe<loop_histogram_t>(channels.Of<loop_histogram_t>(),
                                   [this, joint](const loop_histogram_t& heard) {
                                     loop_histogram_t histogram = heard;
                                     histogram.role = Named(joint, heard.role);
                                     timing_.Add(histogram);
                                   });
}

std::string StackWatch::Named(const std::string& joint, const std::string& source) const {
  return joint.empty() ? source : joint + " " + source;
}

bool StackWatch::IsOfAPlant(int64_t session) const {
  return std::any_of(statuses_.begin(), statuses_.end(), [&](const auto& entry) {
    const process_status_t& status = entry.second.status;
    return process::IsPlant(status.role) && status.session == session;
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
  for (const auto& [key, heard] : statuses_) {
    const process_status_t& status = heard.status;
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
  for (const Stack& stack : stacks_) bus_.Publish(stack.channels.Of<process_status_t>(), question);
}

std::vector<std::string> StackWatch::Present(const std::vector<std::string>& roles,
                                             const std::optional<std::string>& joint) const {
  std::vector<std::string> names;
  for (const auto& [key, heard] : statuses_) {
    const process_status_t& status = heard.status;
    if (joint && stacks_[heard.stack].joint != *joint) continue;
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
    const process_status_t& status = entry.second.status;
    return status.session == stop.addressee && BelongsHere(status);
  });
}

std::vector<std::string> StackWatch::FaultsLeft() const {
  return summary_.FaultsLeft([this](int64_t session) { return IsOfAnotherStack(session); });
}

// Whether a process of that session has a role that a process of this launch has too. A loop that this launch
// does not start may be started by hand: it belongs to this stack. Joints inside a limb have its process id.
bool StackWatch::IsOfAnotherStack(int64_t session) const {
  if (session == 0 || spread_) return false;
  bool foreign = false;
  for (const auto& [key, heard] : statuses_) {
    const process_status_t& status = heard.status;
    if (status.session != session) continue;
    const auto is_ours = [&](const Expected& expected) {
      return status.pid == expected.pid || (expected.own && status.role == expected.role);
    };
    const auto has_its_role = [&](const Expected& expected) {
      return status.role == expected.role ||
             (process::IsPlant(status.role) && process::IsPlant(expected.role));
    };
    if (std::any_of(expected_.begin(), expected_.end(), is_ours)) return false;
    foreign = foreign || std::any_of(expected_.begin(), expected_.end(), has_its_role);
  }
  return foreign;
}

// The plants, each of which stands for its run; while no plant has been heard, each process by itself.
std::vector<const StackWatch::Heard*> StackWatch::Addressees() const {
  std::vector<const Heard*> all, plants;
  for (const auto& [key, heard] : statuses_) {
    if (!BelongsHere(heard.status) || process::HasLeft(heard.status)) continue;
    all.push_back(&heard);
    if (process::IsPlant(heard.status.role)) plants.push_back(&heard);
  }
  return plants.empty() ? all : plants;
}

void StackWatch::PublishStop(const std::string& reason, int exit_code) {
  stop_t stop;
  stop.utime = clock_.Utime();
  stop.tick = -1;
  stop.session = identity_.session;
  stop.source = "launch";
  stop.reason = reason;
  stop.exit_code = exit_code;
  for (const Heard* addressee : Addressees()) {
    stop.addressee = addressee->status.session;
    bus_.Publish(stacks_[addressee->stack].channels.Of<stop_t>(), stop);
  }
}

}  // namespace hydro::launch
