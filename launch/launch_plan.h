// Determines which processes of a configuration a launch starts, and with which arguments.
#pragma once

#include <string>
#include <vector>

#include "launch/logic/children.h"
#include "settings/stack_config.h"

namespace hydro::launch {

// The requests of the command line.
struct LaunchRequest {
  std::string config_file;
  std::vector<std::string> overrides;  // "section.key=value", passed on to every process
  std::string log_file;                // --log; empty: no logger runs
  bool force = false;                  // --force: the logger may replace a log
  std::string host;                    // --host; empty: every process runs on this machine
  std::string timing_file;             // --timing; empty: no report
  bool quiet = false;                  // --quiet: errors and warnings only
  bool json = false;                   // --json: one JSON object a line
};

// Looks for programs in `programs_folder`, then on PATH. Throws InputError when a program is missing or the
// hosts of the [[process]] sections do not match `request.host`.
LaunchPlan PlanLaunch(const settings::StackConfig& config, const LaunchRequest& request,
                      const std::string& programs_folder);

}  // namespace hydro::launch
