// What an effect adds to a balance, over its own variable: what the runs lack without it beside what the model
// has with it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "diagnose/data/diagnosis.h"
#include "diagnose/data/run_data.h"

namespace hydro::diagnose {

// The term of `effect`, one of the model's, in the balance where it is largest; empty for an effect that acts
// through time (own_variable.h), through states of its own, or not at all in these runs.
std::optional<FoundTerm> TermOf(const model::ModelDescription& model, const std::string& effect,
                                const std::vector<const RunData*>& runs, int jobs);

}  // namespace hydro::diagnose
