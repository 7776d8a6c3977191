// How well models predict over several horizons: windows of the runs, each from a start of its own. Whole runs
// add up every small error of a model; windows show what it knows of the next moments.
#pragma once

#include <vector>

#include "diagnose/data/diagnosis.h"
#include "diagnose/search/explanation.h"

namespace hydro::diagnose {

// Of the model as given, refitted, and with what was found, over a quarter of `seconds`, `seconds`, and four
// times that. Runs held out in turn are predicted by models that did not see them. Windows are spread evenly
// over the runs. Those that one of the models cannot be simulated over are left out.
std::vector<HorizonGap> HorizonGaps(const SearchContext& context, double seconds, const Explanation& given,
                                    const Explanation& refit, const Explanation& best);

}  // namespace hydro::diagnose
