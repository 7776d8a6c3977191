// Runs a controller or driver of the user's own as a program: finds it, and tells it what it must know
// (docs/own_controller.md, docs/own_driver.md).
#pragma once

#include <string>
#include <vector>

#include "settings/stack_config.h"

namespace hydro::process {

// The path of the program that `command` names: a name with a slash is relative to `folder`, any other is
// looked up on PATH. Throws InputError, which begins with `place`, when there is no such program or it cannot
// be executed.
std::string FindOwnProgram(const std::string& command, const std::string& folder, const std::string& place);

// The information that a program of the user's own needs to take part in a stack.
struct OwnTask {
  std::string role;                        // position_ctrl, pressure_ctrl or driver
  std::string config_file;                 // an absolute path
  std::vector<std::string> overrides;      // "section.key=value"
  std::vector<std::string> expected = {};  // for a driver: roles that it waits for besides the loops
};

// This process's environment, with these variables added: HYDRO_ROLE, HYDRO_CONFIG, HYDRO_SET (a line for
// each override), HYDRO_EXPECT (likewise), HYDRO_BUS_URL, HYDRO_CHANNEL_SUFFIX, HYDRO_RATE_HZ, HYDRO_TIME
// (lockstep or realtime), HYDRO_EVERY (ticks from one answer of that role to the next), HYDRO_POSITION_EVERY
// (ticks from one pressure command to the next), HYDRO_COMMAND_DELAY (ticks from a command's tick to the one
// at which it acts), HYDRO_STALE_TICKS (an older pressure command is stale), and PYTHONPATH with the folder
// of our Python modules before the user's, if it is found from `programs_folder`.
std::vector<std::string> OwnEnvironment(const settings::StackConfig& config, const OwnTask& task,
                                        const std::string& programs_folder);

// The path of the program with that name on PATH, or where that is not set in the folders of `otherwise`;
// empty when there is none.
std::string ProgramOnPath(const std::string& name, const char* otherwise = "");

// The folder of the running program.
std::string OwnFolder();

}  // namespace hydro::process
