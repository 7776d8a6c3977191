// A recording and its mirror image, which no model can tell apart.
#pragma once

#include <optional>
#include <vector>

#include "diagnose/recording/recording_mistake.h"

namespace hydro::diagnose {

// Except for the arm's weight, the equations stay the same when command, motor and arm change sign and the
// two sides change places. Every set of mistakes therefore has a twin that explains a recording as well. The
// result is empty where no sidecar can state the twin.
std::optional<std::vector<RecordingMistake>> SeenFromTheOtherSide(
    const std::vector<RecordingMistake>& mistakes, const runs::MeasuredRun& run);

}  // namespace hydro::diagnose
