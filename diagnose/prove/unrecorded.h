// What can be said where signals were not recorded: effects that no balance shows, and those of the oil as one class.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "diagnose/balances/make_rows.h"
#include "diagnose/evidence/set_weights.h"
#include "diagnose/prove/proof_context.h"
#include "diagnose/recording/diagnosis.h"

namespace hydro::diagnose {

// What stands in an explanation for all effects of the oil, which cannot be told apart without pressures.
inline constexpr char kSomeOil[] = "some effect of the oil";

// Effects of the context's changes of which the runs have no column of their own, and why; `names`: the sets that the rows show. None
// where all signals were recorded that balances need, and none that simulation alone judges.
std::vector<Unjudged> UnjudgedOf(const ProofContext& context, const ScanRuns& runs,
                                 const std::vector<std::string>& names);

// Effects that act only in the oil's balances (ScanRuns::OilOnly) cannot be told apart: nothing, and the sets that hold the truth nine
// times in ten, without them. What the balances do not hold likely is not tried: it might take the place of what they cannot name.
std::vector<ChangeSet> SetsWithout(const std::set<std::string>& oil, const ExplanationWeights& weights);
// The same explanations, with one name for all effects of the oil.
ExplanationWeights AsOneClass(const std::set<std::string>& oil, ExplanationWeights weights);

// Whether some value differs by run ("run.T_s").
bool NamesARun(const ChangeSet& set);

}  // namespace hydro::diagnose
