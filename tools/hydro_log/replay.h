// hydro-log replay: feeds recorded states to a controller and compares its commands with the recorded ones.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "runs/recorded/run_log.h"

namespace hydro::hydro_log {

enum class ReplayedController { kPressure, kPosition };

struct ReplayResult {
  int64_t states = 0;                     // number of states that were fed
  int64_t answers = 0;                    // recorded commands that were compared
  std::optional<std::string> difference;  // the first difference, as one line; none: bit-identical
  // The first tick at which the log lacks what the controller was given; commands from there on were not
  // compared, and `not_compared` counts them.
  std::optional<int64_t> gap_tick = std::nullopt;
  int64_t not_compared = 0;
  // The commands are those of a device that ran eq. (16) itself. `not_judged` counts those that cannot be
  // told right from wrong, because a change of gains was on its way or taking effect.
  bool on_device = false;
  int64_t not_judged = 0;
};

// Builds the controller from the log's own configuration and model and feeds it each recorded state in tick
// order. The pressure loop gets each pressure command just before the first state for which the log shows it
// in force, so a real-time run replays exactly, whatever the order of arrival was. Compares every field of
// the commands except utime, session and sequence, and leaves out commands from wall-clock watchdogs (a stale
// state, the end of the run). The voltages of a front end that ran eq. (16) itself (driver.mode =
// "loop_on_device") are compared to within the rounding of single precision. `speed` is in recorded seconds
// per wall second; 0: as fast as possible. Throws InputError when the log has no description of its run, no
// states, or no commands of the controller.
ReplayResult Replay(const runs::RunLog& log, ReplayedController controller, double speed);

}  // namespace hydro::hydro_log
