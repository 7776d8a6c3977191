// Detects samples that are too far apart to show anything of an actuator. Usually the times are in another
// unit than stated.
#pragma once

#include <string>

#include "runs/measured_run.h"

namespace hydro::runs {

// s between samples. Slower recorders do not show the motion of such a machine.
inline constexpr double kSlowestSamples = 0.25;

// The unit in which a time column may be whose samples are that many s apart, as a text for people: " (is the
// column in us? unit = \"us\")". Empty where no unit makes the samples fit such a machine.
std::string TimeUnitHint(double interval);

// Throws InputError, with that hint, when half of the run's samples are farther apart than kSlowestSamples.
void RequireFastSamples(const MeasuredRun& run);

}  // namespace hydro::runs
