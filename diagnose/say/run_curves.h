// Measured signals and those of the model before and after, for pictures.
#pragma once

#include <optional>
#include <vector>

#include "diagnose/recording/diagnosis.h"
#include "diagnose/say/gaps.h"

namespace hydro::diagnose {

// One entry for each run, fitted runs first. Runs held out in turn are shown as predicted by the model that
// did not see them. Curves are empty where a run cannot be simulated.
std::vector<RunCurves> CurvesOf(const ProofContext& context, const Proof& proof, const WholeRuns& whole);

// For effects that act through time: the stretch of a run (a 25th of it) and the signal in which the model
// that was found differs most, in noise units, from the same model without `effect`. Searches the fitted
// runs. Returns nothing if the two models do not differ or one of them cannot be simulated.
std::optional<FoundStretch> StretchOf(const ProofContext& context, const Proof& proof, const WholeRuns& whole,
                                      const std::string& effect);

}  // namespace hydro::diagnose
