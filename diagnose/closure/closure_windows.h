// Windows on which closures are fitted and judged.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "diagnose/data/run_data.h"
#include "model/terms/description.h"

namespace hydro::diagnose {

struct ClosureWindows {
  std::vector<RunData> all;
  std::vector<const RunData*> chosen;  // among `all`
};

// At most this many windows judge, of other parts of the fitted runs or of the held-out runs.
inline constexpr size_t kJudgingWindows = 12;

// Of all runs' windows of `seconds`, at most `most`, evenly spread: every `stride`-th from `first` on.
ClosureWindows WindowsOfRuns(const std::vector<const RunData*>& runs, double seconds,
                             const model::Parameters& model, size_t most, size_t first, size_t stride);

// The squared gap of each window, predicted from a start of its own; infinite where it cannot be simulated.
std::vector<double> GapsOf(const model::ModelDescription& model, const ClosureWindows& windows, int jobs);

// The typical squared gaps of two predictions, geometric means over the windows, as the search compares explanations: the
// worst few windows do not decide. A window that cannot be simulated counts as far off.
std::pair<double, double> Compare(const std::vector<double>& before, const std::vector<double>& after);

// Of the squared gap above the noise: what a closure has to take.
inline constexpr double kWorthwhile = 0.3;

// Whether that is so, and the gain material.
bool Worthwhile(const std::pair<double, double>& gaps);

// No other start of a window is tried: its first samples say where it begins.
inline constexpr double kNeverInDoubt = 1e300;

}  // namespace hydro::diagnose
