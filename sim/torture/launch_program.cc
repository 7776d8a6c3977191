// The launcher as a simulated process.
#include <memory>

#include "base/input_error.h"
#include "launch/logic/stack_launch.h"
#include "sim/torture/active_fault.h"
#include "sim/torture/launched_children.h"
#include "sim/torture/programs.h"
#include "sim/torture/world.h"

namespace hydro::torture {
namespace {

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
