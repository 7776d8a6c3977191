// A launch: starts the processes of a stack, watches them until the run has ended, and ends them in order.
#pragma once

#include "launch/launch_plan.h"
#include "settings/stack_config.h"

namespace hydro::launch {

// Runs the plan until no process is left. The children's lines and the launcher's own go to `out_fd` and
// `err_fd`. SIGINT, SIGTERM and SIGHUP end the run in order, a second SIGINT at once. Returns the exit code:
// 0 when the run ended in order, 1 when something failed, 2 when a process refused its input. Before anything
// is started, it throws InputError for a bad bus URL and BusError when the bus cannot work. Call it before
// the process has other threads.
int Launch(const settings::StackConfig& config, const LaunchPlan& plan, const LaunchRequest& request,
           int out_fd, int err_fd, const LaunchTiming& timing = {});

// Does the work of hydro-launch for a command line: loads the configuration, plans, launches.
int LaunchStack(const LaunchRequest& request);

}  // namespace hydro::launch
