// Which processes of a configuration a launch starts, and with which arguments.
#pragma once

#include <string>
#include <vector>

#include "launch/child_process.h"
#include "settings/stack_config.h"

namespace hydro::launch {

// What the command line asks for.
struct LaunchRequest {
  std::string config_file;
  std::vector<std::string> overrides;  // "section.key=value", passed on to every process
  std::string log_file;                // --log; empty: no logger runs
  std::string host;                    // --host; empty: everything on this machine
  std::string timing_file;             // --timing; empty: no report
};

struct LaunchPlan {
  std::vector<ChildSpec> children;
  bool spread = false;               // other processes of the stack run on other hosts
  std::vector<std::string> remarks;  // lines that the user should see
  std::string timing_file;           // where the report on how the loops kept time goes, .json; empty: none
};

// Programs are taken from `programs_folder`, else from PATH. Throws InputError when a program is missing, and
// when the hosts of the [[process]] sections and `request.host` do not fit.
LaunchPlan PlanLaunch(const settings::StackConfig& config, const LaunchRequest& request,
                      const std::string& programs_folder);

// The role under which a program announces itself: "hydro-pressure-ctrl" is "pressure_ctrl".
std::string RoleOf(const std::string& program);

// The folder of the running program.
std::string OwnFolder();

}  // namespace hydro::launch
