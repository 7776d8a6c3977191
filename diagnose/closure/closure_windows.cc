#include "diagnose/closure/closure_windows.h"

#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "diagnose/data/windows.h"
#include "diagnose/fit/comparison.h"
#include "diagnose/fit/start_fit.h"

namespace hydro::diagnose {

ClosureWindows WindowsOfRuns(const std::vector<const RunData*>& runs, double seconds,
                             const model::Parameters& model, size_t most, size_t first, size_t stride) {
  ClosureWindows windows;
  windows.all = WindowsOf(runs, seconds, model);
  windows.chosen = EvenlySpread(windows.all, most, first, stride);
  return windows;
}

std::vector<double> GapsOf(const model::ModelDescription& model, const ClosureWindows& windows, int jobs) {
  Hypothesis held;
  held.model = model;
  std::vector<double> gaps(windows.chosen.size(), INFINITY);
  ParallelFor(gaps.size(), jobs, [&](size_t w) {
    const Fitted fitted = FitStart(held, *windows.chosen[w], windows.chosen[w]->start, kNeverInDoubt);
    if (fitted.ok()) gaps[w] = fitted.squared_gap();
  });
  return gaps;
}

std::pair<double, double> Compare(const std::vector<double>& before, const std::vector<double>& after) {
  static constexpr double kFarOff = 1e12;
  const auto typical = [](const std::vector<double>& gaps) {
    double sum = 0;
    for (const double gap : gaps) sum += std::log(std::clamp(gap, 1e-6, kFarOff));
    return std::exp(sum / static_cast<double>(std::max<size_t>(gaps.size(), 1)));
  };
  return {typical(before), typical(after)};
}

bool Worthwhile(const std::pair<double, double>& gaps) {
  return Material(gaps.first, gaps.second) && gaps.first - gaps.second >= kWorthwhile * (gaps.first - 1);
}

}  // namespace hydro::diagnose
