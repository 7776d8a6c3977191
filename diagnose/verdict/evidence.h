// The evidence for each explanation that a search tried, on windows and on whole runs.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "diagnose/search/wide_search.h"
#include "diagnose/verdict/weights.h"

namespace hydro::diagnose {

// What an explanation claims: the labels of its effects joined with " + "; else the values that it frees, each
// as "parameter b", or "parameters" where they are more than kMostChanges; else "as given". Values that are
// fitted beside an effect are not part of the claim.
std::string ClaimOf(const Hypothesis& hypothesis);
inline constexpr char kAsGiven[] = "as given";

std::vector<const Explanation*> PointersToAll(const std::vector<Explanation>& tried);
// The best explanation of a claim among those that were predicted; null when there is none.
const Explanation* BestOf(const std::vector<Explanation>& tried, const std::string& claim);
// The least squared gap among those that were predicted; infinite when there is none.
double LeastGap(const std::vector<Explanation>& tried);

// Of those that were predicted. `runs`: that each block is from.
Contest ContestOf(const std::vector<const Explanation*>& tried, const std::vector<std::string>& runs);

// The evidence that decided between explanations: that of windows where these decide, else that of whole runs.
Contest DecidingContest(const SearchContext& context, const SearchResult& search, const Explanation& refit,
                        const WindowTrials& windows);

// How probable each claim is. Windows say it of everything tried there; where they come near the noise, whole
// runs share out among those proved what windows leave to them. Once whole runs are explained to the noise, what is
// materially behind on windows has no part. Far from the noise whole runs say little, because small errors add up
// over them.
std::map<std::string, double> WeightsOf(const SearchContext& context, const SearchResult& search,
                                        const Explanation& refit, const WindowTrials& windows);

}  // namespace hydro::diagnose
