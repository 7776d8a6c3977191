#include "diagnose/verdict/ranking.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "base/number_text.h"

namespace hydro::diagnose {

namespace {

std::string Gap(double squared) { return ShortNumber(std::sqrt(squared), 3); }

size_t OwnNumbers(const Change& change) {
  if (change.effect.empty()) return 1;
  size_t numbers = 0;
  for (const model::ParameterInfo& parameter : model::FindEffect(change.effect)->parameters)
    numbers += parameter.is_name() ? 0 : 1;
  return numbers;
}

// The tried explanation that adds only `change` to the given model; null when there is none.
const Explanation* AddedAlone(const std::vector<Explanation>& tried, const Change& change) {
  const Explanation* best = nullptr;
  for (const Explanation& one : tried) {
    if (one.changes().size() != 1 || !(one.changes().front() == change)) continue;
    if (best == nullptr || one.fitted.sum < best->fitted.sum) best = &one;
  }
  return best;
}

// The best tried explanation that has all changes of `best` and `change` as well.
const Explanation* AddedToBest(const SearchResult& search, const Change& change) {
  for (const Explanation& one : search.tried) {
    if (one.changes().size() != search.best.changes().size() + 1 || !one.fitted.hypothesis.Has(change))
      continue;
    const bool all = std::all_of(search.best.changes().begin(), search.best.changes().end(),
                                 [&](const Change& had) { return one.fitted.hypothesis.Has(had); });
    if (all && !one.blocks.sums.empty()) return &one;
  }
  return nullptr;
}

}  // namespace

std::vector<Candidate> Ranking(const SearchContext& context, const SearchResult& search) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  const double correlation = CorrelationOf(context.runs, search.best.fitted);
  std::vector<Candidate> candidates;
  for (const Rated& rated : search.rated) {
    Candidate candidate;
    candidate.id = rated.change.Label();
    candidate.score = rated.expected;
    candidate.fit = candidate.held_out = kNan;
    double fall = rated.expected * static_cast<double>(search.given.fitted.count);
    const Explanation* alone = AddedAlone(search.tried, rated.change);
    if (alone != nullptr) {
      candidate.fit = std::sqrt(alone->squared_gap());
      if (!alone->blocks.sums.empty()) candidate.held_out = std::sqrt(alone->held_out_gap());
      fall = search.given.fitted.sum - alone->fitted.sum;
    }
    candidate.p_value =
        PValue(fall, search.best.squared_gap(), correlation, OwnNumbers(rated.change), search.rated.size());
    const Explanation* on_top = AddedToBest(search, rated.change);
    if (search.best.fitted.hypothesis.Has(rated.change)) {
      candidate.rejected_because = "";
    } else if (!rated.failure.empty()) {
      candidate.rejected_because = "could not be tried: " + rated.failure;
    } else if (on_top != nullptr && !search.best.changes().empty()) {
      candidate.rejected_because = "added to " + search.best.changes().front().Label() +
                                   ", it changes the held-out gap only from " +
                                   Gap(search.best.held_out_gap()) + " to " + Gap(on_top->held_out_gap());
    } else if (alone != nullptr && !alone->blocks.sums.empty()) {
      candidate.rejected_because = "held-out gap " + Gap(alone->held_out_gap()) + " with it, " +
                                   Gap(search.best.held_out_gap()) + " with what was found";
    } else if (alone != nullptr) {
      candidate.rejected_because = "refitted, it leaves a gap of " + Gap(alone->squared_gap());
    } else {
      const double expected = std::max(0.0, search.given.squared_gap() - rated.expected);
      candidate.rejected_because = rated.expected <= 0
                                       ? "the score test expects no gain from it"
                                       : "the score test expects it to leave a gap of " + Gap(expected);
    }
    candidates.push_back(candidate);
  }
  const auto order = [](const Candidate& c) {
    const double gap = !std::isnan(c.held_out) ? c.held_out : std::numeric_limits<double>::infinity();
    const double fit = !std::isnan(c.fit) ? c.fit : std::numeric_limits<double>::infinity();
    return std::make_tuple(!c.rejected_because.empty(), gap, fit, -c.score);
  };
  std::stable_sort(candidates.begin(), candidates.end(),
                   [&](const Candidate& a, const Candidate& b) { return order(a) < order(b); });
  return candidates;
}

}  // namespace hydro::diagnose
