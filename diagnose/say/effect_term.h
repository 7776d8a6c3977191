// What an effect adds to a balance, over the variable where it acts: what the runs lack without it beside what the
// model has with it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnose/balances/rows.h"
#include "diagnose/data/diagnosis.h"
#include "diagnose/data/run_data.h"

namespace hydro::diagnose {

// A balance that an effect adds to, and the variable of MotionVariables over which it is best seen there.
struct OwnVariable {
  BalanceKind balance = BalanceKind::kTorque;
  std::string variable;
};
// The likeliest first; empty for effects that act through time, as lags and late sensors do.
std::vector<OwnVariable> OwnVariables(const model::EffectDescription& effect);

// The term of `effect`, one of the model's, in the balance where it is largest; empty for an effect that acts
// through time, or not at all in these runs.
std::optional<FoundTerm> TermOf(const model::ModelDescription& model, const std::string& effect,
                                const std::vector<const RunData*>& runs, int jobs);

}  // namespace hydro::diagnose
