// What windows are too short for: an effect or a value so small that only whole runs show it.
#pragma once

#include <string>
#include <vector>

#include "diagnose/prove/proof.h"

namespace hydro::diagnose {

// Where windows of the runs are predicted to the noise but whole runs are not, and the model as given is near enough for whole runs to say
// something: tries each change of the context by a score test of the whole runs, fits the few that it expects most of, and takes what
// takes most of the gap of held-out runs, judged as windows are; then whole runs decide. Otherwise `near`, what windows have found.
// `at_the_noise`: whether windows are. `unlikely`: ids of effects that are not tried.
Proof ProvedOnWholeRuns(const ProofContext& context, const Hypothesis& as_given, Proof near,
                        bool at_the_noise, const std::vector<std::string>& unlikely = {});

// What the set leaves of each predicted run.
std::vector<WindowGap> OverRuns(const ProofContext& context, const ProvedSet& set);

// The squared gap of whole runs: the mean of all residuals' squares; infinite where a run cannot be simulated.
double MeanSquare(const std::vector<WindowGap>& runs);

}  // namespace hydro::diagnose
