// Measured signals beside those of the model before and after, for pictures.
#pragma once

#include <optional>
#include <vector>

#include "diagnose/recording/diagnosis.h"
#include "diagnose/say/gaps.h"

namespace hydro::diagnose {

// One a run, fitted runs first; runs held out in turn are shown as predicted by the model that did not see them. Empty curves where a
// run cannot be simulated.
std::vector<RunCurves> CurvesOf(const ProofContext& context, const Proof& proof, const WholeRuns& whole);

// For effects that act through time: the stretch of a run, a 25th of it, and the signal in which the model with what was found differs
// most in noise units from the same model without `effect`. Among the fitted runs; nothing if they do not differ or one of the two
// cannot be simulated.
std::optional<FoundStretch> StretchOf(const ProofContext& context, const Proof& proof, const WholeRuns& whole,
                                      const std::string& effect);

}  // namespace hydro::diagnose
