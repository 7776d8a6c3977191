// Checks the exit code of a launch, and what the launch leaves behind.
#include <fmt/format.h>

#include <algorithm>
#include <csignal>

#include "process/fault_codes.h"
#include "sim/torture/invariants/launch_invariants.h"

namespace hydro::torture {
namespace {

constexpr TrueTime kControlLasts =
    1'000'000'000;  // ns after the last obeyed command during which the stack counts as working

}  // namespace

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
  if (child.role() == Role::kLogger && !config_.logger.required && !launch_->cause)
    return;  // the run continues
  Cause("the end of " + NameOf(child));
}

std::string LaunchInvariants::WhatFailed() const {
  if (!launch_->failed.empty() || launch_->faults.size() > kMostFaults) return launch_->failed;
  for (const auto& [key, active] : launch_->faults) {
    if (active && !process::IsWarning(key.second)) return "it has heard of no end of " + key.second;
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
