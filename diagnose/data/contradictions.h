// What a recording says against itself, whatever the rig is: it takes no prediction to see.
#pragma once

#include <string>
#include <vector>

#include "model/terms/description.h"
#include "runs/measured_run.h"

namespace hydro::diagnose {

struct Contradiction {
  std::string text;        // one line: what was found, what mends it
  bool only_sign = false;  // which the catalogue has as an effect too
};

// In this order: angles that jump by a turn; speeds that are not the rates of their angles, by another unit or the other sign; a bypass
// that is said to be open while p2 - p1 takes the motor's torque, which `model` gives roughly.
std::vector<Contradiction> Contradictions(const model::ModelDescription& model, const runs::MeasuredRun& run);

}  // namespace hydro::diagnose
