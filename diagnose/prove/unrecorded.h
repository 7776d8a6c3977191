// What can be said if signals were not recorded: which effects no balance shows, and the effects of the oil
// as one class.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "diagnose/balances/make_rows.h"
#include "diagnose/evidence/set_weights.h"
#include "diagnose/prove/proof_context.h"
#include "diagnose/recording/diagnosis.h"

namespace hydro::diagnose {

// The name in an explanation for all effects of the oil, which cannot be told apart without pressures.
inline constexpr char kSomeOil[] = "some effect of the oil";

// Those effects among the context's changes for which the runs have no column of their own, and why. `names`
// has the sets that the rows show. The list is empty where all signals that the balances need were recorded,
// and it leaves out effects that only simulation judges.
std::vector<Unjudged> UnjudgedOf(const ProofContext& context, const ScanRuns& runs,
                                 const std::vector<std::string>& names);

// Effects that act only in the oil's balances (ScanRuns::OilOnly) cannot be told apart. Returns the empty
// set, and the likeliest sets that together hold the truth nine times in ten, all without these effects. Sets
// that the balances find unlikely are not tried, because they might take the place of the effects that cannot
// be named.
std::vector<ChangeSet> SetsWithout(const std::set<std::string>& oil, const ExplanationWeights& weights);
// The same explanations with one name for all effects of the oil.
ExplanationWeights AsOneClass(const std::set<std::string>& oil, ExplanationWeights weights);

// The names of the parameters that differ by run ("T_s" for "run.T_s"), and whether there are any.
std::vector<std::string> ParametersByRun(const ChangeSet& set);
bool NamesARun(const ChangeSet& set);

}  // namespace hydro::diagnose
