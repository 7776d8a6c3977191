// States new values of the model's own numbers in a diagnosis.
#pragma once

#include <vector>

#include "diagnose/fit/intervals.h"
#include "diagnose/prove/proof.h"
#include "diagnose/recording/diagnosis.h"

namespace hydro::diagnose {

// Adds those base parameters and those numbers of the given model's effects for which the best set has other
// values. `intervals` are those of its free numbers. When values were refitted all together, only those that
// clearly changed are added. The others, and those that the runs do not show apart from each other, become
// remarks. A value that was estimated and then held has no interval (NaN).
void DescribeValues(const ProofContext& context, const Proof& proof, const std::vector<Interval>& intervals,
                    Diagnosis* d);

}  // namespace hydro::diagnose
