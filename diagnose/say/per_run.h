// Values that belong to a run and not to the rig: friction of the day, payload, temperature.
#pragma once

#include <string>
#include <vector>

#include "diagnose/prove/proof_context.h"
#include "diagnose/recording/diagnosis.h"

namespace hydro::diagnose {

// The base parameters whose values differ from run to run in `model`, as the balances estimate them: those `asked` for, else the one
// that the balances say most clearly to differ, if its own value for each run predicts windows of the run that the balances did not
// see better than one value for all. `allowed`: those that may differ from the model, as in BaseParameters(). Held-out runs have a
// value too. What balances are measured by (k_1, k_2) has none.
std::vector<ValueByRun> ValuesByRun(const ProofContext& context, const model::ModelDescription& model,
                                    const std::vector<std::string>& asked,
                                    const std::vector<size_t>& allowed);

// "T_s differs from run to run by 6 % (3.3 to 3.9 in-lbf)", with what it takes of the gap.
std::string RemarkOn(const ValueByRun& value);

}  // namespace hydro::diagnose
