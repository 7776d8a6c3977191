// hydro-log replay --controller COMMAND: feeds a recorded run to a controller of the user's own, which runs
// as a process of its own, and compares its commands with the recorded ones.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "runs/recorded/run_log.h"
#include "tools/hydro_log/replay.h"

namespace hydro::hydro_log {

struct ControllerReplayRequest {
  std::vector<std::string> command;  // a program and its arguments
  std::string role;                  // role whose commands are compared: pressure_ctrl or position_ctrl
  double speed = 0;                  // recorded seconds per wall second; 0: as fast as the controller answers
  std::chrono::steady_clock::duration limit = std::chrono::seconds(5);  // for each answer
};

struct ControllerReplayResult {
  ReplayResult replay;
  std::optional<std::string> failure;  // it died, hung, or did not start, and when; `replay` is then empty
};

// Replays in lockstep: where the log has an answer to a state, the next state is sent only when the
// controller's answer has arrived. The checks and the comparison are those of Replay(), which is for this
// project's controllers. Throws InputError, process::StartError, bus::BusError.
ControllerReplayResult ReplayController(const runs::RunLog& log, const ControllerReplayRequest& request);

// The name of the user's own program that had this role in the run; empty when our program had it.
std::string OwnProgramOf(const runs::RunLog& log, const std::string& role);

// The role of the user's own program in the run, according to the configuration; empty when there was none,
// or when there were two.
std::string OwnRoleOf(const runs::RunLog& log);

}  // namespace hydro::hydro_log
