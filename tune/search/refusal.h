// Explains goals that cannot be met: which limit prevents them, and what would be possible.
#pragma once

#include <string>

#include "tune/search/search.h"

namespace hydro::tune {

// Before any search: what the motor, the arm's travel and the sampling interval alone rule out. Empty when
// nothing rules out the goals.
std::string RefusalByTheMotor(const StepJudge& judge, const Goals& goals);

// After the search: empty when the best gains meet the goals.
std::string RefusalBySearch(const StepJudge& judge, const Goals& goals, const SearchResult& result);

// Why the best gains are no proposal: the arm does not settle with them, or they are no better than the
// configured ones. Empty when they are a proposal.
std::string RefusalToPropose(const StepJudge& judge, const Goals& goals, const Tried& best,
                             const Tried& configured);

}  // namespace hydro::tune
