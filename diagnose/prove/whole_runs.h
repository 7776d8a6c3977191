// Finds what windows are too short for: an effect or a value so small that only whole runs show it.
#pragma once

#include <string>
#include <vector>

#include "diagnose/prove/proof.h"

namespace hydro::diagnose {

// Acts where windows of the runs are predicted to the noise but whole runs are not, and where the given model
// is close enough for whole runs to be informative. Tries each change of the context by a score test on the
// whole runs, fits the few that promise most, and takes the one that reduces the gap of held-out runs most,
// judged as windows are. Whole runs then decide. In all other cases it returns `near`, the result of the
// windows. `at_the_noise` says whether the windows are predicted to the noise. `unlikely` lists ids of
// effects that are not tried.
Proof ProvedOnWholeRuns(const ProofContext& context, const Hypothesis& as_given, Proof near,
                        bool at_the_noise, const std::vector<std::string>& unlikely = {});

// What the set leaves of each predicted run.
std::vector<WindowGap> OverRuns(const ProofContext& context, const ProvedSet& set);

// The squared gap of whole runs: the mean of all squared residuals; infinite where a run cannot be simulated.
double MeanSquare(const std::vector<WindowGap>& runs);

// Whether the set takes most of what the model as given leaves of whole runs, over which it was judged.
bool TakesMost(const ProvedSet& given, const ProvedSet& set);

}  // namespace hydro::diagnose
