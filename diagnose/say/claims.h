// What sets of changes claim, in the words of a report's candidates.
#pragma once

#include <string>
#include <vector>

#include "diagnose/fit/hypothesis.h"
#include "diagnose/recording/diagnosis.h"

namespace hydro::diagnose {

inline constexpr char kAsGiven[] = "as given";

// What a hypothesis claims: the labels of its effects joined with " + ". Without effects, the values that it
// frees, each as "parameter b", or "parameters" if they are more than kMostChanges; otherwise "as given".
// Values that are fitted beside an effect are not part of the claim.
std::string ClaimOf(const Hypothesis& hypothesis);

// The claim of a set of changes as the balances name them: "sensor.skew(p1)", "value.b", "run.T_s".
std::string ClaimOfSet(const std::vector<std::string>& changes);

// The change's label as the balances name it: "sensor.skew(p1)" for "sensor.skew (p1)".
std::string NameInSets(const Change& change);

// The probability of the change: the total weight of all explanations that include it; 0 where none does.
double WeightOf(const Change& change, const std::vector<WeightedSet>& explanations);

}  // namespace hydro::diagnose
