// hydro-log replay --controller COMMAND: feeds a recorded run to a controller of the user's own, a process of its own, and
// compares its commands with the recorded ones.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "runs/run_log.h"
#include "tools/hydro_log/replay.h"

namespace hydro::hydro_log {

struct OwnReplayRequest {
  std::vector<std::string> command;  // a program and its arguments
  std::string role;                  // whose commands are compared: pressure_ctrl or position_ctrl
  double speed = 0;                  // recorded seconds per wall second; 0: as fast as it answers
  std::chrono::steady_clock::duration limit = std::chrono::seconds(5);  // for each answer
};

struct OwnReplayResult {
  ReplayResult replay;
  std::optional<std::string>
      failure;  // it died, hung, or did not begin, and when; then `replay` holds nothing
};

// In lockstep: the next state is sent when the state's answer is there, where the log has one. Both as Replay() does otherwise,
// for our own. Throws InputError, process::StartError, bus::BusError.
OwnReplayResult ReplayOwn(const runs::RunLog& log, const OwnReplayRequest& request);

// The program of the user's own that the run had for that role, by name; empty when it had ours.
std::string OwnProgramOf(const runs::RunLog& log, const std::string& role);

// The role of the run's own program, from its configuration; empty when it had none, or two.
std::string OwnRoleOf(const runs::RunLog& log);

}  // namespace hydro::hydro_log
