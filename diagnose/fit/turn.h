// Finds the shaft's angle at a run's start when the model has something that repeats with the shaft and no
// sensor shows its zero.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "diagnose/recording/run_data.h"
#include "model/response.h"

namespace hydro::diagnose {

// Turns the start by the part of the effect's period for which the model predicts the run best. Returns the
// start itself where the angle is known (UnknownTurn). A fit finds the angle only from a nearby start.
model::StartState AtBestTurn(const model::ModelDescription& model, const RunData& run,
                             const model::StartState& start);

// The turns of windows that many models predict in turn. Each window is searched once for models with the
// same periods and phases. From there, the correction of the start follows what another model needs:
// searching for every model again was more than half of all that was simulated. Each window may be used by
// one thread at a time.
class KnownTurns {
 public:
  explicit KnownTurns(size_t windows) : known_(windows) {}

  // AtBestTurn(), or the turn that a model with the same periods had in the window at this place.
  model::StartState Turned(size_t place, const model::ModelDescription& model, const RunData& window,
                           const model::StartState& start);

 private:
  struct Known {
    std::vector<std::string> effects;
    std::vector<double> periods, phases;
    double turn;
  };
  std::vector<std::vector<Known>> known_;  // of each window
};

}  // namespace hydro::diagnose
