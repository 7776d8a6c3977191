// Checks the exit code of a launch, and what the launch leaves behind.
#include "sim/torture/invariants/launch_invariants.h"

#include <fmt/format.h>

#include <algorithm>
#include <csignal>
#include <hydro/fault_t.hpp>
#include <hydro/process_status_t.hpp>
#include <hydro/stop_t.hpp>

#include "bus/channels.h"
#include "process/fault_codes.h"
#include "process/participant.h"
#include "process/status.h"

namespace hydro::torture {
namespace {

// From docs/launch.md, "Ending": how long a stop may take to arrive after a child's end, how long children
// may take to end by themselves, and after SIGTERM. The logger ends after the others.
constexpr TrueTime kStopArrives = kSecond / 2;
constexpr TrueTime kPatience = 3 * kSecond;
constexpr TrueTime kGrace = 3 * kSecond;
constexpr TrueTime kLoggerGrace = 10 * kSecond;
// Time for its questions before the start, its last messages, and the error of a slow clock.
constexpr TrueTime kRest = kSecond;

TrueTime GraceOf(const SimulatedProcess& child) {
  return child.role() == Role::kLogger ? kLoggerGrace : kGrace;
}

constexpr TrueTime kControlLasts =
    1'000'000'000;  // ns after the last obeyed command during which the stack counts as working

}  // namespace

LaunchInvariants::LaunchInvariants(const settings::StackConfig& config, Network& network, const TrueTime* now,
                                   Observer& observer)
    : config_(config),
      now_(now),
      observer_(observer),
      stop_(network.ChannelNumber(bus::Channels(config.bus.channel_suffix).Of<stop_t>())),
      fault_(network.ChannelNumber(bus::Channels(config.bus.channel_suffix).Of<fault_t>())),
      status_(network.ChannelNumber(bus::Channels(config.bus.channel_suffix).Of<process_status_t>())) {}

void LaunchInvariants::OnBegin(const SimulatedProcess& launcher) {
  launch_ = Launch{};
  launch_->launcher = launcher.number();
  launch_->frozen_until = launcher.frozen_until();
}

std::vector<const SimulatedProcess*> LaunchInvariants::children() const {
  return launch_ ? launch_->children : std::vector<const SimulatedProcess*>{};
}

void LaunchInvariants::OnStart(const SimulatedProcess& child) {
  if (launch_->children.empty()) launch_->started = *now_;
  launch_->children.push_back(&child);
}

bool LaunchInvariants::Owns(const SimulatedProcess& process) const {
  return std::find(launch_->children.begin(), launch_->children.end(), &process) != launch_->children.end();
}

bool LaunchInvariants::IsStranger(int64_t session) const {
  const auto heard = launch_->roles.find(session);
  if (heard == launch_->roles.end()) return false;
  const auto has_a_role_of = [&](const SimulatedProcess* child) {
    return heard->second.contains(NameOf(*child)) ||
           (child->role() == Role::kPlant &&
            std::any_of(heard->second.begin(), heard->second.end(), process::IsPlant));
  };
  const auto is_of = [&](const SimulatedProcess* child) { return child->identity().session == session; };
  const auto& children = launch_->children;
  return std::any_of(children.begin(), children.end(), has_a_role_of) &&
         std::none_of(children.begin(), children.end(), is_of);
}

void LaunchInvariants::Cause(const std::string& why) {
  if (launch_->cause) return;
  launch_->cause = *now_;
  launch_->why = why;
  launch_->frozen = std::max<TrueTime>(0, launch_->frozen_until - *now_);
}

void LaunchInvariants::OnFrozen(TrueTime until) {
  if (!launch_) return;
  const TrueTime since = std::max(*now_, launch_->frozen_until);
  if (until <= since) return;
  launch_->frozen += until - since;
  launch_->frozen_until = until;
}

void LaunchInvariants::OnSignal(const SimulatedProcess& child, int signal) {
  if (!launch_) return;
  if (signal == SIGTERM) launch_->told.try_emplace(&child, *now_);
  if (signal != SIGKILL) return;
  launch_->failed = NameOf(child) + " had to be killed";
  if (launch_->second_interrupt) return;
  const auto told = launch_->told.find(&child);
  const TrueTime grace = GraceOf(child) * 97 / 100;  // its clock may drift
  if (told == launch_->told.end() || *now_ - told->second < grace)
    observer_.Report("a launch kills only what does not end on SIGTERM",
                     NameOf(child) + " was not given its time");
}

void LaunchInvariants::OnInterrupt() {
  if (!launch_) return;
  Cause("SIGINT");
  if (++launch_->interrupts != 2) return;
  launch_->may_fail = "a second SIGINT";
  launch_->second_interrupt = *now_;
  launch_->frozen = std::max<TrueTime>(launch_->frozen, launch_->frozen_until - *now_);
}

std::optional<TrueTime> LaunchInvariants::due() const {
  if (!launch_ || !launch_->cause) return std::nullopt;
  if (launch_->second_interrupt) return *launch_->second_interrupt + launch_->frozen + kRest;
  const bool logs = std::any_of(launch_->children.begin(), launch_->children.end(),
                                [](const auto* child) { return child->role() == Role::kLogger; });
  TrueTime due = *launch_->cause + kStopArrives + kPatience + kGrace + (logs ? kLoggerGrace : 0);
  // A process that does not end on SIGTERM is killed when its time is over.
  for (const auto& [child, told] : launch_->told) {
    if (!child->ended()) due = std::min(due, told + GraceOf(*child));
  }
  return due + launch_->frozen + kRest;
}

void LaunchInvariants::ReportOverdue() {
  observer_.Report("every launch ends",
                   fmt::format("it still runs {:.3f} s after: {}",
                               static_cast<double>(*now_ - *launch_->cause) * 1e-9, launch_->why));
}

void LaunchInvariants::OnHandled(const Packet& packet, const SimulatedProcess& launcher) {
  if (!launch_) return;
  if (packet.channel == stop_) OnStop(packet, launcher);
  if (packet.channel == status_) OnStatus(packet);
  if (packet.channel != fault_) return;
  fault_t fault;
  if (!Decode(packet, &fault)) return;
  launch_->faults[{fault.session, fault.code}] = fault.active != 0;
  if (launch_->faults.size() > kMostFaults) launch_->may_fail = "it has heard of too many faults";
}

void LaunchInvariants::OnStatus(const Packet& packet) {
  process_status_t status;
  if (packet.origin == Origin::kChanged) launch_->confused = true;
  if (!Decode(packet, &status)) return;
  if (launch_->children.empty() && status.role != process::kLaunchRole && !process::HasLeft(status))
    launch_->others = true;
  launch_->roles[status.session].insert(status.role);
  for (const SimulatedProcess* child : launch_->children) {
    if (child->number() == packet.sender && status.state != process_status_t::FAILED)
      launch_->ready.try_emplace(packet.sender, *now_);
  }
}

// A stop does not count if it is not for one of its children, or if it is for a child that the launcher has
// not heard yet.
void LaunchInvariants::OnStop(const Packet& packet, const SimulatedProcess& launcher) {
  stop_t stop;
  if (!Decode(packet, &stop) || packet.sender == launch_->launcher || launch_->stop_heard) return;
  const auto heard = [&](const SimulatedProcess* child) {
    return child->identity().session == stop.addressee && launch_->ready.contains(child->number());
  };
  // A stop counts when it comes before a signal is handled, or while the launcher waits for the stop that
  // explains a child's end.
  const bool open = launch_->confused || launch_->early_end || launcher.identity().stop_signal != 0;
  if (stop.exit_code != 0 && open) launch_->may_fail = "it has heard a stop with an error";
  if (stop.addressee != 0 &&
      (launch_->confused || std::none_of(launch_->children.begin(), launch_->children.end(), heard)))
    return;
  launch_->stop_heard = true;
  if (launch_->early_end && *now_ - *launch_->early_end < kStopArrives * 9 / 10) launch_->early_end.reset();
  if (stop.exit_code != 0 && !launch_->cause) launch_->failed = "it has heard a stop with an error";
  Cause("a stop");
}

std::string NameOf(const SimulatedProcess& process) {
  return std::string(TargetName(static_cast<int>(process.role())));
}

void LaunchInvariants::OnEnd(const SimulatedProcess& process) {
  if (!launch_) return;
  if (process.number() == launch_->launcher) {
    if (!process.killed()) OnLauncherEnd(process);
    launch_.reset();
  } else if (Owns(process)) {
    OnChildEnd(process);
  }
}

void LaunchInvariants::OnChildEnd(const SimulatedProcess& child) {
  const bool in_order = child.killed_by() == SIGTERM || (!child.killed() && child.exit_code() == 0);
  if (!in_order)
    launch_->failed = NameOf(child) + (child.killed() ? " was killed" : " has ended with an error");
  if (in_order && !launch_->cause && !launch_->early_end) launch_->early_end = *now_;
  if (child.role() == Role::kLogger && !config_.logger.required && !launch_->cause) {
    launch_->may_fail = "the logger has ended before the run";
    return;  // the run continues
  }
  Cause("the end of " + NameOf(child));
}

std::string LaunchInvariants::WhatFailed() const {
  if (!launch_->failed.empty() || launch_->faults.size() > kMostFaults) return launch_->failed;
  for (const auto& [key, active] : launch_->faults) {
    if (active && !IsStranger(key.first) && !process::IsWarning(key.second))
      return "it has heard of no end of " + key.second;
  }
  return "";
}

std::string LaunchInvariants::WhatMayHaveFailed() const {
  if (std::string failed = WhatFailed(); !failed.empty()) return failed;
  if (!launch_->may_fail.empty()) return launch_->may_fail;
  if (launch_->early_end) return "a process ended and no stop was heard";
  // When the motor obeys, all processes are there, no matter which of their messages were lost.
  if (observer_.last_obeyed() > std::max(launch_->started, *now_ - kControlLasts)) return "";
  const auto in_time = static_cast<TrueTime>(0.95e9 * config_.time.start_timeout_s);
  for (const SimulatedProcess* child : launch_->children) {
    const auto ready = launch_->ready.find(child->number());
    if (ready == launch_->ready.end() ? *now_ - launch_->started > in_time
                                      : ready->second - launch_->started > in_time)
      return NameOf(*child) + " was not ready in time";
  }
  return "";
}

void LaunchInvariants::OnLauncherEnd(const SimulatedProcess& launcher) {
  for (const SimulatedProcess* child : launch_->children) {
    if (!child->ended())
      observer_.Report("a launch that has ended has no children", NameOf(*child) + " still runs");
  }
  const int code = launcher.exit_code();
  const bool refused = launch_->children.empty();
  const std::string failed = WhatFailed(), may = WhatMayHaveFailed();
  const bool right = refused     ? code == 2 && launch_->others
                     : code == 0 ? failed.empty()
                                 : code == 1 && !may.empty();
  if (right) return;
  observer_.Report("the exit code of a launch is that of what happened",
                   fmt::format("{}; {}", code,
                               refused       ? "nothing was started"
                               : code == 0   ? failed
                               : may.empty() ? "nothing has failed"
                                             : may));
}

}  // namespace hydro::torture
