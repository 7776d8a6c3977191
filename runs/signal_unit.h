// Units that a sidecar states for its columns.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace hydro::runs {

// How many of `ours` one of `theirs` is: 1e5 for bar and Pa. Empty where `theirs` is no unit or measures
// something else.
std::optional<double> UnitFactor(const std::string& theirs, const std::string& ours);

// The usual units of what `ours` measures, for messages. Any other text for such a unit is taken too.
std::vector<std::string> UnitsLike(const std::string& ours);

}  // namespace hydro::runs
