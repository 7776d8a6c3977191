// Values that belong to a run and not to the rig: friction of the day, payload, temperature.
#pragma once

#include <string>
#include <vector>

#include "diagnose/data/diagnosis.h"
#include "diagnose/search/search_context.h"

namespace hydro::diagnose {

// The base parameters whose values differ from run to run in `model`: those `asked` for, else the one of `allowed`
// (indices in BaseParameters()) that differs most, if its own value for each run predicts the run materially better
// than one value for all, by the windows of the run that were not fitted. Held-out runs have a value too.
std::vector<ValueByRun> ValuesByRun(const SearchContext& context, const model::ModelDescription& model,
                                    const std::vector<std::string>& asked,
                                    const std::vector<size_t>& allowed);

// "T_s differs from run to run by 6 % (3.3 to 3.9 in-lbf)", with what it takes of the gap.
std::string RemarkOn(const ValueByRun& value);

}  // namespace hydro::diagnose
