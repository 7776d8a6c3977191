// Measured signals beside those of the model before and after, for tables and pictures.
#pragma once

#include <vector>

#include "diagnose/data/diagnosis.h"
#include "diagnose/search/search.h"

namespace hydro::diagnose {

// By signal, over all runs: root-mean-square differences in the signal's unit.
std::vector<SignalGap> SignalGaps(const SearchContext& context, const Explanation& given,
                                  const Explanation& refit, const Explanation& best);

// One a run, fitted runs first; runs held out in turn are shown as predicted by the fit that did not see
// them.
std::vector<RunCurves> CurvesOf(const SearchContext& context, const Explanation& given,
                                const Explanation& best);

}  // namespace hydro::diagnose
