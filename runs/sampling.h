// Whether a log has every state of its run, or only the telemetry of a limb, which leaves some out
// (sim/limb/telemetry.h).
#pragma once

#include <cstdint>
#include <string>

#include "runs/run_log.h"

namespace hydro::runs {

// Ticks from one state to the next where a limb sent its joints' states at a chosen rate (limb.telemetry_hz);
// 1: every state was sent.
int64_t SampleTicks(const RunMessages& messages);

// "a state every 20 ticks (limb.telemetry_hz)"; empty where every state was sent.
std::string DescribeSampling(int64_t sample_ticks);

// Throws InputError where states are missing on purpose, because the work named by `needs_it` ("a replay")
// would take them for lost.
void RequireEveryState(const RunLog& log, const std::string& needs_it);

}  // namespace hydro::runs
