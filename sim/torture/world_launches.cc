// The World's launches: what a simulated launcher does to its children, and its faults.
#include <fmt/format.h>

#include <algorithm>
#include <csignal>

#include "sim/torture/active_fault.h"
#include "sim/torture/world.h"

namespace hydro::torture {
namespace {

constexpr TrueTime kBegins = 50'000'000;  // ns within which a started process begins

}  // namespace

SimulatedProcess& World::StartChild(Role role) {
  SimulatedProcess& child = BeginRole(role);
  child.FreezeUntil(std::max(now_ + static_cast<TrueTime>(start_random_.Index(kBegins)),
                             awake_at_[static_cast<size_t>(role)]));
  launches_.OnStart(child);
  if (role == Role::kPlant) observer_.OnHeartbeat(child);  // from now on, the plant expects heartbeats
  return child;
}

// Not at once, because the sender runs on a fiber of its own.
void World::SendSignal(const SimulatedProcess& process, int signal) {
  launches_.OnSignal(process, signal);
  Say(process.number(), fmt::format("is sent signal {}", signal));
  Push(now_, Happening::kSignal, process.number() * kSignals + signal);
  NoteDue();
}

void World::Signal(SimulatedProcess& process, int signal) {
  if (process.ended()) return;
  if (signal == SIGKILL || !process.begun()) {
    Destroy(process, signal);
    return;
  }
  process.Signal(signal);
  observer_.OnSignal(process);
}

// PR_SET_PDEATHSIG (launch/child_process.cc).
void World::KillLauncher() {
  SimulatedProcess* const launcher = Find(Role::kLauncher);
  if (launcher == nullptr) return;
  const std::vector<const SimulatedProcess*> orphans = launches_.children();
  Destroy(*launcher, SIGKILL);
  for (const SimulatedProcess* orphan : orphans) {
    if (!orphan->ended()) SendSignal(*orphan, SIGTERM);
  }
}

void World::InterruptLauncher() {
  SimulatedProcess* const launcher = Find(Role::kLauncher);
  if (launcher == nullptr) return;
  if (!launcher->begun()) {
    Destroy(*launcher, SIGINT);
    return;
  }
  if (launcher->identity().stop_signal == 0) launches_.OnInterrupt();  // a second pending one is lost
  Say(launcher->number(), "is sent SIGINT");
  launcher->Signal(SIGINT);
  NoteDue();
}

void World::HangLauncher(TrueTime until) {
  SimulatedProcess* const launcher = Find(Role::kLauncher);
  if (launcher == nullptr) return;
  launcher->FreezeUntil(until);
  launches_.OnFrozen(until);
}

// Schedules a check at the time by which the current launch must have ended, if it has a reason to end.
void World::NoteDue() {
  const int launcher = launches_.launcher();
  const std::optional<TrueTime> due = launches_.due();
  if (!due || (launcher == due_launcher_ && *due >= due_at_)) return;
  due_launcher_ = launcher;
  due_at_ = *due;
  Push(*due, Happening::kLaunchDue, launcher);
}

void World::CheckLaunchIsOver(int launcher) {
  if (launches_.launcher() != launcher) return;
  if (const TrueTime due = *launches_.due(); due > now_) {  // it stood still in the meantime
    due_at_ = due;
    Push(due, Happening::kLaunchDue, launcher);
  } else {
    launches_.ReportOverdue();
  }
}

}  // namespace hydro::torture
