// Which base parameters the runs can determine.
#pragma once

#include <cstddef>
#include <vector>

#include "diagnose/fit/fit.h"

namespace hydro::diagnose {

// Indices in BaseParameters() of parameters, among `allowed`, whose values the runs determine together to
// better than about a third; as many as possible. Eqs. (4) to (15) also hold in other units of torque and of
// volume, so the runs can never determine all of them: those that they determine least stay as given.
std::vector<size_t> Identifiable(const Hypothesis& given, const std::vector<const RunData*>& runs,
                                 const std::vector<model::StartState>& starts,
                                 const std::vector<size_t>& allowed, const Sizes& sizes, int jobs);

}  // namespace hydro::diagnose
