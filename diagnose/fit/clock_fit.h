// Corrects the clocks of a recording by simulation.
#pragma once

#include <vector>

#include "diagnose/data/alignment.h"
#include "diagnose/fit/fit.h"

namespace hydro::diagnose {

// Balances of measured signals (AlignClocks) see command, speed and pressures as the recorder filtered them,
// but a simulation should be driven by what was really there. If every one of `runs` had clocks that differ,
// this corrects the delays, by whole numbers of samples that are the same in all runs, so that the model
// predicts `runs` best with its friction, inertia, leakage and stiffness free. `held_out` gets the same
// corrections and has no say in them. `clocks` are corrected too, and their intervals widened by as much as
// they moved.
void CorrectClocks(const model::ModelDescription& model, const std::vector<size_t>& allowed_base, int jobs,
                   std::vector<RunData>* runs, std::vector<RunData>* held_out,
                   std::vector<ClockDelay>* clocks);

}  // namespace hydro::diagnose
