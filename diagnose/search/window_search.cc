#include "diagnose/search/window_search.h"

#include <algorithm>

#include "diagnose/data/windows.h"

namespace hydro::diagnose {

namespace {

constexpr double kShortest = 60;  // samples
constexpr double kWindowsPerRun = 4;

}  // namespace

double SearchHorizon(const std::vector<const RunData*>& runs) {
  const double shortest = ShortestDuration(runs);
  const double sampled = kShortest * SampleInterval(runs);
  return std::max(std::min(std::max(kHorizon, sampled), shortest / kWindowsPerRun), 0.25 * sampled);
}

SearchContext OnWindows(const SearchContext& context, const std::vector<const RunData*>& fitted,
                        const std::vector<const RunData*>& choosing) {
  SearchContext on_windows = context;
  on_windows.runs = fitted;
  on_windows.held_out = choosing;
  on_windows.windows = true;
  return on_windows;
}

}  // namespace hydro::diagnose
