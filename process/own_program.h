// A controller or driver of the user's own as a program: where it is found, and what it is told
// (docs/own_controller.md, docs/own_driver.md).
#pragma once

#include <string>
#include <vector>

#include "settings/stack_config.h"

namespace hydro::process {

// The path of the program that `command` names: with a slash it counts from `folder`, else it is looked for
// on PATH. Throws InputError, which begins with `place`, when there is none or it cannot be executed.
std::string FindOwnProgram(const std::string& command, const std::string& folder, const std::string& place);

// What a program of the user's own must know to take part in a stack.
struct OwnTask {
  std::string role;                        // position_ctrl, pressure_ctrl or driver
  std::string config_file;                 // an absolute path
  std::vector<std::string> overrides;      // "section.key=value"
  std::vector<std::string> expected = {};  // a driver's: roles that it waits for besides the loops
};

// This process's environment, and in it: HYDRO_ROLE, HYDRO_CONFIG, HYDRO_SET (a line for each override),
// HYDRO_EXPECT (likewise), HYDRO_BUS_URL, HYDRO_CHANNEL_SUFFIX, HYDRO_RATE_HZ, HYDRO_TIME (lockstep or
// realtime), HYDRO_EVERY (ticks from one answer of that role to the next), HYDRO_POSITION_EVERY (from one
// pressure command to the next), HYDRO_COMMAND_DELAY (from a command's tick to that from which it acts),
// HYDRO_STALE_TICKS (an older pressure command is stale), and PYTHONPATH with the folder of our Python
// modules before the user's, where it is found from `programs_folder`.
std::vector<std::string> OwnEnvironment(const settings::StackConfig& config, const OwnTask& task,
                                        const std::string& programs_folder);

// The program of that name on PATH; empty when there is none.
std::string ProgramOnPath(const std::string& name);

// The folder that the running program is in.
std::string OwnFolder();

}  // namespace hydro::process
