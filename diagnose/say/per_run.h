// Values that belong to a run and not to the rig: friction of the day, payload, temperature.
#pragma once

#include <string>
#include <vector>

#include "diagnose/prove/proof_context.h"
#include "diagnose/recording/diagnosis.h"

namespace hydro::diagnose {

// The base parameters of `model` whose values differ from run to run, as the balances estimate them: those in
// `asked`. If it is empty, of those that the balances say differ, the one whose own value for each run most
// improves the prediction of windows that the balances did not see, if it improves it.
// `allowed` has those that may differ from the model, as in BaseParameters(). Held-out runs have a value too.
// Parameters in which balances are measured (k_1, k_2) are excluded.
std::vector<ValueByRun> ValuesByRun(const ProofContext& context, const model::ModelDescription& model,
                                    const std::vector<std::string>& asked,
                                    const std::vector<size_t>& allowed);

// What tests values of which the set that was found has one for each run.
std::string RemarkOnOwnValues(const std::vector<std::string>& by_run);

// "T_s differs from run to run by 6 % (3.3 to 3.9 in-lbf)", followed by its effect on the gap.
std::string RemarkOn(const ValueByRun& value);

}  // namespace hydro::diagnose
