// The shaft's angle at a run's start, where what repeats with the shaft is modelled and no sensor shows its zero.
#pragma once

#include "diagnose/recording/run_data.h"
#include "model/response.h"

namespace hydro::diagnose {

// The start turned by the part of the effect's period from which the model predicts the run best; the start itself where the angle
// is known (UnknownTurn). A fit finds the angle only from near it.
model::StartState AtBestTurn(const model::ModelDescription& model, const RunData& run,
                             const model::StartState& start);

}  // namespace hydro::diagnose
