// Finds the shaft's angle at a run's start when the model has something that repeats with the shaft and no
// sensor shows its zero.
#pragma once

#include "diagnose/recording/run_data.h"
#include "model/response.h"

namespace hydro::diagnose {

// Turns the start by the part of the effect's period for which the model predicts the run best. Returns the
// start itself where the angle is known (UnknownTurn). A fit finds the angle only from a nearby start.
model::StartState AtBestTurn(const model::ModelDescription& model, const RunData& run,
                             const model::StartState& start);

}  // namespace hydro::diagnose
