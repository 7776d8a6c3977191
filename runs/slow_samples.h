// Samples so far apart that they show nothing of an actuator: mostly times in another unit than is said.
#pragma once

#include <string>

#include "runs/measured_run.h"

namespace hydro::runs {

// s between samples: slower recorders do not show the motion of such a machine.
inline constexpr double kSlowestSamples = 0.25;

// What a time column whose samples are that many s apart may be in, for a person: " (is the column in us? unit =
// \"us\")"; empty where no unit makes them those of such a machine.
std::string TimeUnitHint(double interval);

// Throws InputError, with that hint, when half of the run's samples are farther apart than kSlowestSamples.
void RequireFastSamples(const MeasuredRun& run);

}  // namespace hydro::runs
