#include "launch/launch.h"

#include <unistd.h>

#include <algorithm>
#include <string>

#include "base/new_file.h"
#include "base/read_files.h"
#include "launch/stack_launch.h"

namespace hydro::launch {
namespace {

// Checked before anything is started: a logger that fails later stops its stack, and with it any other stack
// that runs on this port.
void CheckLog(const LaunchPlan& plan, const std::string& file) {
  const bool ours = std::any_of(plan.children.begin(), plan.children.end(),
                                [](const ChildSpec& child) { return child.program() == "hydro-logger"; });
  if (!ours) return;
  CheckKeeps(file);
  if (IsBeingWritten(file)) {
    throw InputError(file + ": is being written by another process; stop that process or give another name");
  }
  CheckCanBeCreated(file);
}

}  // namespace

int Launch(const settings::StackConfig& config, const LaunchPlan& plan, int out_fd, int err_fd,
           const LaunchTiming& timing) {
  return StackLaunch(config, plan, out_fd, err_fd, timing).Run();
}

int LaunchStack(const LaunchRequest& request) {
  const settings::StackConfig config = settings::LoadStackConfig(request.config_file, request.overrides);
  const LaunchPlan plan = PlanLaunch(config, request, OwnFolder());
  CheckLog(plan, request.log_file);
  if (!plan.timing_file.empty()) {
    const TimingFiles timing(plan.timing_file);
    CheckDistinct({request.log_file, timing.json(), timing.page()});
  }
  return Launch(config, plan, STDOUT_FILENO, STDERR_FILENO);
}

}  // namespace hydro::launch
