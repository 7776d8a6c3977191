// A recording and its mirror image, which no model can tell apart.
#pragma once

#include <optional>
#include <vector>

#include "diagnose/recording/recording_mistake.h"

namespace hydro::diagnose {

// The equations stay the same when command, motor and arm turn round and the sides change places, but for the arm's
// weight: so every set of mistakes has a twin that explains a recording as well. Empty where no sidecar can say it.
std::optional<std::vector<RecordingMistake>> SeenFromTheOtherSide(
    const std::vector<RecordingMistake>& mistakes, const runs::MeasuredRun& run);

}  // namespace hydro::diagnose
