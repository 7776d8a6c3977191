#include "sim/torture/launched_children.h"

#include <algorithm>
#include <csignal>

#include "sim/torture/active_fault.h"
#include "sim/torture/world.h"

namespace hydro::torture {

void LaunchedChildren::Child::Signal(int signal_number) {
  if (running()) world.SendSignal(process, signal_number);
}

int32_t LaunchedChildren::Start(const launch::ChildSpec& spec) {
  const auto role = spec.role() == "driver" ? Role::kPlant : static_cast<Role>(*TargetNamed(spec.role()));
  children_.push_back(std::make_unique<Child>(world_, world_.StartChild(role), spec));
  stop_.Add(children_.back().get());
  return children_.back()->process.identity().id;
}

// Whether there is something for which a poll() would return at once.
bool LaunchedChildren::AnythingToReport() const {
  return launcher_.identity().stop_signal != 0 ||
         std::any_of(children_.begin(), children_.end(),
                     [](const auto& child) { return child->running() && child->process.ended(); });
}

void LaunchedChildren::Wait(TimePoint deadline) {
  stop_.TakeSteps(launcher_.machine().Now());
  for (const auto& child : children_) child->process.Beat();
  if (!AnythingToReport()) launcher_.SleepUntil(std::min(deadline, stop_.NextStep()));
  Reap();
  stop_.TakeSteps(launcher_.machine().Now());
}

void LaunchedChildren::Reap() {
  for (const auto& child : children_) {
    const SimulatedProcess& process = child->process;
    if (!child->running() || !process.ended()) continue;
    child->reaped = true;
    const launch::ProcessEnd end{process.killed() ? 0 : process.exit_code(), process.killed_by()};
    ended_.push_back({child->spec.label, child->spec.program(), child->spec.role(), process.identity().id,
                      end, stop_.terminated(child.get()), stop_.hung(child.get())});
  }
}

std::optional<launch::Ended> LaunchedChildren::NextEnded() {
  if (ended_.empty()) return std::nullopt;
  launch::Ended ended = ended_.front();
  ended_.pop_front();
  return ended;
}

std::optional<int> LaunchedChildren::NextSignal() {
  const int signal = launcher_.TakeSignal();
  return signal == 0 ? std::nullopt : std::optional(signal);
}

void LaunchedChildren::KillAll() {
  stop_.Begin(launcher_.machine().Now());
  for (const auto& child : children_) child->Signal(SIGKILL);
}

}  // namespace hydro::torture
