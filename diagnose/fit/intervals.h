// How precisely the fitted parameters are known.
#pragma once

#include <vector>

#include "diagnose/fit/fit.h"

namespace hydro::diagnose {

// What is wrong with a model is alike in all rows of all runs, but evidence and fits take rows for
// independent. A third of what they say counts: of a difference between scores (measured on 63 rigs), and of
// the information about a number.
inline constexpr double kTemperature = 3;
// The same where a model leaves this squared gap, in noise units: noise is independent in all rows, and 1
// there; only what is left beside it is alike.
double TemperatureAt(double squared_gap);

struct Interval {
  double low = 0, high = 0;
};

// 95 % intervals of the fit's free parameters, in the order of Free(). They come from the fit's information,
// in which residuals count by what the model leaves of them and by how long that lasts, and from the scatter
// between windows or runs, where there are at least three; both times `temperature`. They allow for
// idealisations of the equations, both in the equations' own form and in the numbers that are held.
std::vector<Interval> Intervals(const Fitted& fitted, const std::vector<const RunData*>& runs, int jobs,
                                double temperature = 1);

// Which of the fit's free numbers, in the order of Hypothesis::Free(), the runs do not show apart from
// others: without prior knowledge their standard deviation would be three times as large.
std::vector<bool> RestOnKnown(const Fitted& fitted);

}  // namespace hydro::diagnose
