// Other values of the model's own numbers, as a diagnosis states them.
#pragma once

#include <vector>

#include "diagnose/data/diagnosis.h"
#include "diagnose/fit/intervals.h"
#include "diagnose/search/explanation.h"

namespace hydro::diagnose {

// Adds the base parameters, and the numbers of effects that the model as given has, that the explanation has other values of.
// `intervals`: of its free numbers. Of those that were refitted all together, only what is surely another counts; the others, and
// those that the runs do not show apart from each other, are remarks. What was estimated and then held has no interval (NaN).
void DescribeValues(const SearchContext& context, const Explanation& best,
                    const std::vector<Interval>& intervals, Diagnosis* d);

}  // namespace hydro::diagnose
