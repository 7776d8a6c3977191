// Which base parameters the runs tell anything about.
#pragma once

#include <cstddef>
#include <vector>

#include "diagnose/fit/fit.h"

namespace hydro::diagnose {

// Indices in BaseParameters() of those, among `allowed`, whose values the runs determine together to better
// than about a third; a set as large as that can be. Eqs. (4) to (15) hold for other units of torque and of
// volume as well, so that never all can be told: those that the runs say least about stay as given.
std::vector<size_t> Identifiable(const Hypothesis& given, const std::vector<const RunData*>& runs,
                                 const std::vector<model::StartState>& starts,
                                 const std::vector<size_t>& allowed, const Sizes& sizes, int jobs);

}  // namespace hydro::diagnose
