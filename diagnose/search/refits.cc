#include "diagnose/search/refits.h"

#include <algorithm>

#include "diagnose/fit/comparison.h"

namespace hydro::diagnose {

namespace {

// A change is not refitted if the score test expects less of it than this share of the best.
constexpr double kWorthTrying = 0.25;

}  // namespace

bool SameChanges(const Hypothesis& a, const Hypothesis& b) {
  if (a.changes.size() != b.changes.size()) return false;
  return std::all_of(a.changes.begin(), a.changes.end(), [&](const Change& change) { return b.Has(change); });
}

void Pick(const Fitted& from, const RefitLimits& limits, std::vector<std::vector<Scanned>>* scanned,
          std::vector<Scanned>* pool) {
  auto& rows = *scanned;
  std::erase_if(rows, [](const auto& starts) { return starts.empty() || !starts.front().failure.empty(); });
  std::stable_sort(rows.begin(), rows.end(),
                   [](const auto& a, const auto& b) { return a.front().expected > b.front().expected; });
  // The score test is linear; a nonlinear effect can gain several times what the test expects.
  const double least = std::max(0.3 * kLeastGain * static_cast<double>(from.count),
                                rows.empty() ? 0 : kWorthTrying * rows.front().front().expected);
  for (size_t i = 0; i < rows.size() && i < limits.changes; ++i) {
    for (size_t s = 0; s < rows[i].size() && s < limits.starts; ++s) {
      if (s > 0 && rows[i][s].expected < 0.5 * rows[i].front().expected) break;
      if (rows[i][s].expected < least) continue;
      const bool there = std::any_of(pool->begin(), pool->end(), [&](const Scanned& other) {
        return s == 0 && SameChanges(other.start, rows[i][s].start);
      });
      if (!there) pool->push_back(rows[i][s]);
    }
  }
}

std::vector<Fitted> BestOfEach(std::vector<Fitted> fits) {
  std::vector<Fitted> best;
  for (Fitted& fit : fits) {
    if (!fit.ok()) continue;
    const auto same = std::find_if(best.begin(), best.end(), [&](const Fitted& other) {
      return SameChanges(other.hypothesis, fit.hypothesis);
    });
    if (same == best.end()) {
      best.push_back(std::move(fit));
    } else if (fit.sum < same->sum) {
      *same = std::move(fit);
    }
  }
  std::stable_sort(best.begin(), best.end(), [](const Fitted& a, const Fitted& b) { return a.sum < b.sum; });
  return best;
}

}  // namespace hydro::diagnose
