#include "diagnose/search/predicting_starts.h"

#include <algorithm>
#include <utility>

#include "base/parallel.h"
#include "diagnose/fit/residuals.h"
#include "diagnose/search/race.h"

namespace hydro::diagnose {

std::vector<Scanned> PredictingStarts(const SearchContext& context, const Change& change,
                                      const std::vector<Hypothesis>& all,
                                      const std::vector<model::StartState>& starts, const Fitted& than,
                                      size_t most, double limit) {
  const std::vector<size_t> sample = RaceSample(context.runs.size());
  std::vector<std::pair<double, size_t>> order(all.size());  // sum of squares, place in `all`
  ParallelFor(all.size(), context.jobs, [&](size_t i) {
    order[i] = {0, i};
    for (const size_t r : sample) order[i].first += SumOfSquares(all[i].model, *context.runs[r], starts[r]);
  });
  std::sort(order.begin(), order.end());
  double there = 0;
  for (const size_t r : sample) there += than.runs[r].sum;
  std::vector<Scanned> best;
  for (const auto& [sum, i] : order) {
    if (best.size() >= most || !(sum <= limit * there)) break;
    best.push_back({change, all[i], 0, "", starts});
  }
  return best;
}

}  // namespace hydro::diagnose
