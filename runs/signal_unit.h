// The units that a sidecar states for its columns.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace hydro::runs {

// How many of `ours` make one of `theirs`: 1e5 for bar and Pa. Empty where `theirs` is not a unit or measures
// something else.
std::optional<double> UnitFactor(const std::string& theirs, const std::string& ours);

// The usual units for what `ours` measures, for messages. Any other text for such a unit is also accepted.
std::vector<std::string> UnitsLike(const std::string& ours);

}  // namespace hydro::runs
