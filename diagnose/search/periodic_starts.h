// Starting values for effects that repeat within a turn of the shaft, read off the balances. In a simulation,
// another number of periods is another motion, and derivatives do not lead from one to the other. In a
// balance of smoothed signals, such an effect is linear for each whole number of periods.
#pragma once

#include <vector>

#include "diagnose/data/run_data.h"
#include "diagnose/fit/hypothesis.h"

namespace hydro::diagnose {

// `hypothesis` with one effect among `changes` that repeats within a turn (Role::kPeriods), for each such
// effect where the torque that the balance lacks (SmoothDisturbances) clearly repeats too: one hypothesis for
// each of the likeliest numbers of periods, with the amplitude and phase found in the balance. Empty if the
// runs cannot be smoothed.
std::vector<Hypothesis> WithPeriodic(const Hypothesis& hypothesis, const std::vector<Change>& changes,
                                     const std::vector<const RunData*>& runs, int jobs);

}  // namespace hydro::diagnose
