// Finds at how many periods per turn something repeats with the shaft: a score test for each number of
// periods, on what every hypothesis leaves.
#pragma once

#include <vector>

#include "diagnose/balances/make_rows.h"
#include "diagnose/evidence/set_evidence.h"

namespace hydro::diagnose {

// Such machines have fewer poles, teeth, pistons and vanes than this: the rotor of a stepping motor has 50
// teeth.
inline constexpr int kMostPeriods = 52;

// The fewest periods per turn that the runs can show. At least one run has to cover a repetition, because
// part of a sine could be any smooth load over the angle. Returns more than kMostPeriods when the runs show
// none.
int FewestPeriods(const std::vector<RunMotion>& runs);

// The few likeliest periods of each effect that repeats with the shaft, all in one increasing list. `rows`
// and `evidence` are those of the same runs without such effects.
std::vector<int> LikelyPeriods(const ScanRuns& runs, const Rows& rows, const SetEvidence& evidence, int jobs);

}  // namespace hydro::diagnose
