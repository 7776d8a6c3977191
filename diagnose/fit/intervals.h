// How precisely the fitted parameters are known.
#pragma once

#include <vector>

#include "diagnose/fit/fit.h"

namespace hydro::diagnose {

struct Interval {
  double low = 0, high = 0;
};

// 95 % intervals of the fit's free parameters, in the order of Free(): from the fit's information, with residuals counted by what the
// model leaves of them and by how long that lasts. They allow for what the equations idealise, in their own form and in the numbers
// that are held.
std::vector<Interval> Intervals(const Fitted& fitted, const std::vector<const RunData*>& runs, int jobs);

// Which of the fit's free numbers, in the order of Hypothesis::Free(), the runs do not show apart from others: without what is known
// beforehand their standard deviation would be three times as large.
std::vector<bool> RestOnKnown(const Fitted& fitted);

}  // namespace hydro::diagnose
