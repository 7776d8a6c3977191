// hydro-log replay: feeds a recorded state stream through a controller and compares what it answers with the
// record.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "runs/run_log.h"

namespace hydro::hydro_log {

enum class ReplayedController { kPressure, kPosition };

struct ReplayResult {
  int64_t states = 0;                     // fed
  int64_t answers = 0;                    // recorded commands that were compared
  std::optional<std::string> difference;  // the first one, as one line; none: bit-identical
};

// Builds the controller from the log's own configuration and model and feeds it each recorded state in tick
// order. The pressure loop gets each pressure command just before the state at which the record says that it
// was in force, so a real-time run replays exactly, whatever arrived when. What is compared: every field of
// the answers but utime, session and sequence; commands that wall-clock watchdogs sent (a stale state, the
// end of the run) are left out. speed: recorded seconds per wall second; 0: as fast as possible. Throws
// InputError when the log has no description of its run, no states, or none of the controller's commands.
ReplayResult Replay(const runs::RunLog& log, ReplayedController controller, double speed);

}  // namespace hydro::hydro_log
