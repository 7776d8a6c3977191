// How well models predict over several horizons: windows of the runs, each from a start of its own. Whole runs
// add up every small error of a model; windows show what it knows of the next moments.
#pragma once

#include <vector>

#include "diagnose/data/diagnosis.h"
#include "diagnose/search/explanation.h"

namespace hydro::diagnose {

// Of the model as given, refitted, and with what was found, over 0.1, 0.4 and 1.6 s, as far as the runs are that long. Runs held out
// in turn are predicted by models that did not see them. Windows are spread evenly over the runs. A window that a model cannot be
// simulated over is left out of that model's gap; NaN where none is left.
std::vector<HorizonGap> HorizonGaps(const SearchContext& context, const Explanation& given,
                                    const Explanation& refit, const Explanation& best);

}  // namespace hydro::diagnose
