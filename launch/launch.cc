#include "launch/launch.h"

#include <unistd.h>

#include <algorithm>
#include <optional>
#include <string>

#include "base/new_file.h"
#include "base/read_files.h"
#include "base/standard_output.h"
#include "launch/labelled_output.h"
#include "launch/launch_lock.h"
#include "launch/logic/stack_launch.h"
#include "launch/supervisor.h"
#include "launch/terminal_report.h"
#include "process/own_program.h"
#include "process/stack_bus.h"
#include "settings/limb_config.h"

namespace hydro::launch {
namespace {

// This is checked before anything is started: a logger that fails later stops its stack, and with it any
// other stack that runs on this port.
void CheckLog(const LaunchPlan& plan, const std::string& file) {
  const bool ours = std::any_of(plan.children.begin(), plan.children.end(),
                                [](const ChildSpec& child) { return child.program() == "hydro-logger"; });
  if (!ours) return;
  CheckCanBeCreated(file);
}

}  // namespace

int Launch(const settings::StackConfig& config, const LaunchPlan& plan, const LaunchRequest& request,
           int out_fd, int err_fd, const LaunchTiming& timing) {
  std::optional<LaunchLock> lock;  // held until the launch is over
  LabelledOutput output(out_fd, err_fd, LabelledOutput::WantsColour(out_fd, err_fd));
  Supervisor supervisor(
      output, GraceFor(timing, plan));  // before the bus, whose threads must not receive its signals
  bus::WallClock clock;
  const auto bus = process::OpenStackBus(config.bus);
  TerminalReport report(
      output, config, plan,
      {.status = LabelledOutput::CanDrawStatus(out_fd, err_fd), .quiet = request.quiet, .json = request.json},
      request.log_file);
  StackLaunch launch(*bus, clock, supervisor, report, config, plan, timing);
  lock.emplace(config, plan);
  const int exit_code = launch.Run();
  if (output.lost() == 0) return exit_code;
  report.PrintError(CannotBeWritten(output.lost()));
  output.Flush();
  return exit_code == 0 ? 1 : exit_code;
}

int LaunchStack(const LaunchRequest& request) {
  const settings::StackConfig config = settings::LoadCommonConfig(request.config_file, request.overrides);
  const LaunchPlan plan = PlanLaunch(config, request, process::OwnFolder());
  CheckLog(plan, request.log_file);
  if (!plan.timing_file.empty()) {
    const TimingFiles timing(plan.timing_file);
    CheckDistinct({request.log_file, timing.json(), timing.page()});
  }
  return Launch(config, plan, request, STDOUT_FILENO, STDERR_FILENO);
}

}  // namespace hydro::launch
