// At how many periods a turn something repeats with the shaft: a score test for each, of what every hypothesis leaves.
#pragma once

#include <vector>

#include "diagnose/balances/make_rows.h"
#include "diagnose/evidence/set_evidence.h"

namespace hydro::diagnose {

// Poles, teeth, pistons and vanes of such machines are fewer.
inline constexpr int kMostPeriods = 48;

// The fewest periods a turn that the runs can show: what repeats has to be seen to repeat, in one run at least, and a part of a sine is
// any smooth load over the angle. Beyond kMostPeriods: none.
int FewestPeriods(const std::vector<RunMotion>& runs);

// The likeliest few periods of each effect that repeats with the shaft, all together, increasing. `rows` and `evidence` are those of the
// same runs without such effects.
std::vector<int> LikelyPeriods(const ScanRuns& runs, const Rows& rows, const SetEvidence& evidence, int jobs);

}  // namespace hydro::diagnose
