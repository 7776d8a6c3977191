// Starting values of effects that repeat within a turn of the shaft, read off the balances. To a simulation
// another number of periods is another motion, and its derivatives do not lead from the one to the other; a
// balance of smoothed signals is a straight line in such an effect, for each whole number of periods.
#pragma once

#include <vector>

#include "diagnose/data/run_data.h"
#include "diagnose/fit/hypothesis.h"

namespace hydro::diagnose {

// `hypothesis` with each effect among `changes` that repeats within a turn (Role::kPeriods), where the torque
// balance that it leaves open (SmoothDisturbances) plainly repeats too: with the likeliest numbers of
// periods, and the amplitude and phase that the balance has. Nothing where the runs cannot be smoothed.
std::vector<Hypothesis> WithPeriodic(const Hypothesis& hypothesis, const std::vector<Change>& changes,
                                     const std::vector<const RunData*>& runs, int jobs);

}  // namespace hydro::diagnose
