// Other values of the model's own numbers, as a diagnosis states them.
#pragma once

#include <vector>

#include "diagnose/fit/intervals.h"
#include "diagnose/prove/proof.h"
#include "diagnose/recording/diagnosis.h"

namespace hydro::diagnose {

// Adds the base parameters, and the numbers of effects that the model as given has, that the best set has other values of.
// `intervals`: of its free numbers. Of those that were refitted all together, only what is surely another counts; the others, and
// those that the runs do not show apart from each other, are remarks. What was estimated and then held has no interval (NaN).
void DescribeValues(const ProofContext& context, const Proof& proof, const std::vector<Interval>& intervals,
                    Diagnosis* d);

}  // namespace hydro::diagnose
