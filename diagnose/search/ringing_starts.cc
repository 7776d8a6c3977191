#include "diagnose/search/ringing_starts.h"

#include <algorithm>
#include <utility>

#include "base/parallel.h"
#include "diagnose/fit/residuals.h"
#include "diagnose/search/race.h"

namespace hydro::diagnose {

namespace {

constexpr size_t kMostStarts = 2;  // of one resonance at one frequency
// What begins with so many times the sum of squares that is there does not get below it.
constexpr double kHopeless = 10;

// The starting points of a resonance that rings at `frequency`, the best first.
std::vector<Scanned> BestStartsOf(const SearchContext& context, const Fitted& from, const Change& change, double frequency) {
  Sizes sizes = context.sizes;
  sizes.ringing = {frequency};
  const std::vector<Hypothesis> all = With(from.hypothesis, change, sizes, false);
  const std::vector<size_t> sample = RaceSample(context.runs.size());
  std::vector<std::pair<double, size_t>> order(all.size());  // sum of squares, place in `all`
  ParallelFor(all.size(), context.jobs, [&](size_t i) {
    order[i] = {0, i};
    for (const size_t r : sample) {
      order[i].first += SumOfSquares(all[i].model, *context.runs[r], from.runs[r].start);
    }
  });
  std::sort(order.begin(), order.end());
  double there = 0;
  for (const size_t r : sample) there += from.runs[r].sum;
  std::vector<Scanned> best;
  for (const auto& [sum, i] : order) {
    if (best.size() >= kMostStarts || !(sum < kHopeless * there)) break;
    best.push_back({change, all[i], 0, "", {}});
  }
  return best;
}

}  // namespace

std::vector<Scanned> RingingStarts(const SearchContext& context, const Fitted& from,
                                   const std::vector<Change>& changes) {
  std::vector<Scanned> starts;
  for (const Change& change : changes) {
    if (!model::HasRole(change.effect, model::Role::kFrequency)) continue;
    for (const double frequency : context.ringing) {
      for (Scanned& start : BestStartsOf(context, from, change, frequency)) starts.push_back(std::move(start));
    }
  }
  return starts;
}

}  // namespace hydro::diagnose
