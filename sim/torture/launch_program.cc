// The launcher as a simulated process.
#include <algorithm>
#include <csignal>
#include <deque>
#include <memory>
#include <optional>
#include <vector>

#include "base/input_error.h"
#include "launch/logic/children.h"
#include "launch/logic/stack_launch.h"
#include "launch/logic/stop_sequence.h"
#include "sim/torture/active_fault.h"
#include "sim/torture/machines/simulated_process.h"
#include "sim/torture/programs.h"
#include "sim/torture/world.h"

namespace hydro::torture {
namespace {

// The children of a simulated launcher: processes of the world.
class LaunchedChildren : public launch::Children {
 public:
  // `launcher` is the process whose body uses this.
  LaunchedChildren(World& world, SimulatedProcess& launcher, const launch::Grace& grace)
      : world_(world), launcher_(launcher), stop_(grace) {}

  int32_t Start(const launch::ChildSpec& spec) override;
  void Wait(TimePoint deadline) override;
  std::optional<launch::Ended> NextEnded() override;
  std::optional<int> NextSignal() override;
  void Stop(TimePoint first_signal) override { stop_.Begin(first_signal); }
  bool stopping() const override { return stop_.begun(); }
  void KillAll() override;
  int running() const override { return stop_.running(); }
  size_t unread() const override { return 0; }

 private:
  struct Child : public launch::Stoppable {
    Child(World& w, SimulatedProcess& p, const launch::ChildSpec& s) : world(w), process(p), spec(s) {}
    bool running() const override { return !reaped; }
    bool last() const override { return spec.last; }
    void Signal(int signal_number) override;

    World& world;
    SimulatedProcess& process;
    const launch::ChildSpec spec;
    bool reaped = false;
  };

  bool AnythingToReport() const;
  void Reap();

  World& world_;
  SimulatedProcess& launcher_;
  launch::StopSequence stop_;
  std::vector<std::unique_ptr<Child>> children_;
  std::deque<launch::Ended> ended_;
};

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

// Puts the launcher's output into the tail of a replay.
class TailReport : public launch::LaunchReport {
 public:
  TailReport(World& world, int number) : world_(world), number_(number) {}
  void Print(const std::string& text) override { world_.Say(number_, "says: " + text); }
  void PrintError(const std::string& text) override { world_.Say(number_, "complains: " + text); }
  std::string WriteTiming(const timing::TimingRecord& /*record*/) override { return ""; }

 private:
  World& world_;
  const int number_;
};

// The plan that launch::PlanLaunch() makes for a configuration without [[process]] sections.
launch::LaunchPlan PlanOf(const World& world) {
  launch::LaunchPlan plan;
  const char* const role = world.has_driver() ? "driver" : "plant";
  plan.children = {{role, {std::string("hydro-") + role}, false},
                   {"pressure_ctrl", {"hydro-pressure-ctrl"}, false},
                   {"position_ctrl", {"hydro-position-ctrl"}, false}};
  if (world.has_logger()) plan.children.push_back({"logger", {"hydro-logger"}, true});
  return plan;
}

}  // namespace

SimulatedProcess::Body LaunchProgram(const settings::StackConfig& config, World& world, int number) {
  return [&config, &world, number](bus::Bus& bus, bus::Clock& clock) {
    const launch::LaunchPlan plan = PlanOf(world);
    const launch::LaunchTiming timing;
    LaunchedChildren children(world, world.process(number), launch::GraceFor(timing, plan));
    TailReport report(world, number);
    try {
      return std::make_unique<launch::StackLaunch>(bus, clock, children, report, config, plan, timing)->Run();
    } catch (const InputError& error) {
      report.PrintError(error.what());
      return 2;  // as settings::RunProgram() does
    }
  };
}

}  // namespace hydro::torture
