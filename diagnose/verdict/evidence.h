// The evidence for each explanation that a search tried, on windows and on whole runs.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "diagnose/data/diagnosis.h"
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
// What was tried with the best explanation's changes and as many free values; else with its claim. Null where windows did not.
const Explanation* OnWindowsOf(const WindowTrials& windows, const Hypothesis& best);

// Of those that were predicted. `runs`: that each block is from.
Contest ContestOf(const std::vector<const Explanation*>& tried, const std::vector<std::string>& runs);

// The evidence that decided between explanations: that of windows where these decide, else that of whole runs.
Contest DecidingContest(const SearchContext& context, const SearchResult& search, const Explanation& refit,
                        const WindowTrials& windows);

// The claim of a set of changes as the balances name them: "sensor.skew(p1)", "value.b", "run.T_s".
std::string ClaimOfSet(const std::vector<std::string>& changes);

// How probable each claim is: as the balances' explanations say, where one of them claims what was found. Where none does, because
// balances cannot see it or there are none, the evidence that decided says it.
std::map<std::string, double> WeightsOf(const SearchContext& context, const WideSearch& found,
                                        const std::vector<WeightedSet>& explanations);

}  // namespace hydro::diagnose
