#include "diagnose/search/ringing_starts.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/parallel.h"
#include "diagnose/fit/residuals.h"
#include "diagnose/search/race.h"

namespace hydro::diagnose {

namespace {

constexpr size_t kMostStarts = 4;  // of one resonance

bool IsResonance(const Change& change) {
  if (change.effect.empty()) return false;
  const std::vector<model::ParameterInfo>& parameters = model::FindEffect(change.effect)->parameters;
  return std::any_of(parameters.begin(), parameters.end(), [](const model::ParameterInfo& parameter) {
    return parameter.role == model::Role::kFrequency;
  });
}

// The starting points of one resonance, the best first.
std::vector<Scanned> BestStartsOf(const SearchContext& context, const Fitted& from, const Change& change) {
  Sizes sizes = context.sizes;
  sizes.ringing = context.ringing;
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
  std::vector<Scanned> best;
  for (const auto& [sum, i] : order) {
    if (best.size() >= kMostStarts || !std::isfinite(sum)) break;
    best.push_back({change, all[i], 0, "", {}});
  }
  return best;
}

}  // namespace

std::vector<Scanned> RingingStarts(const SearchContext& context, const Fitted& from,
                                   const std::vector<Change>& changes) {
  std::vector<Scanned> starts;
  if (context.ringing.empty()) return starts;
  for (const Change& change : changes) {
    if (!IsResonance(change)) continue;
    for (Scanned& start : BestStartsOf(context, from, change)) starts.push_back(std::move(start));
  }
  return starts;
}

}  // namespace hydro::diagnose
