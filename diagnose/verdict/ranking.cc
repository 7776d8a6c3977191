#include "diagnose/verdict/ranking.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "base/number_text.h"
#include "diagnose/verdict/evidence.h"

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
    if (best == nullptr || one.squared_gap() < best->squared_gap()) best = &one;
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

std::string ComparedGaps(double with_it, double with_what_was_found) {
  return Gap(with_it) + " with it, " + Gap(with_what_was_found) + " with what was found";
}

// The ranking of one search.
class Ranker {
 public:
  Ranker(const SearchContext& context, const SearchResult& search, const WindowTrials& windows)
      : search_(search), windows_(windows), correlation_(CorrelationOf(context.runs, search.best.fitted)) {
    if (const Explanation* best = OnWindowsOf(windows, search.best.fitted.hypothesis)) {
      best_on_windows_ = best->held_out_gap();
    }
  }

  Candidate Single(const Rated& rated) const {
    Candidate candidate;
    candidate.id = rated.change.Label();
    candidate.fit = candidate.held_out = kNan;
    double fall = 0;
    const Explanation* alone = AddedAlone(search_.tried, rated.change);
    if (alone != nullptr) {
      SetGaps(*alone, &candidate);
      fall = (search_.given.squared_gap() - alone->squared_gap()) *
             static_cast<double>(search_.given.fitted.count);
    }
    if (windows_.decide) fall = SetGapsOfWindows(candidate.id, &candidate);
    candidate.p_value = PValue(fall, search_.best.squared_gap(), correlation_, OwnNumbers(rated.change),
                               search_.rated.size());
    if (!search_.best.fitted.hypothesis.Has(rated.change)) candidate.rejected_because = Why(rated, alone);
    return candidate;
  }

  // An explanation that is not a single change.
  Candidate Other(const std::string& claim) const {
    Candidate candidate;
    candidate.id = claim;
    candidate.fit = candidate.held_out = candidate.p_value = kNan;
    const Explanation* whole = BestOf(search_.tried, claim);
    if (whole != nullptr) SetGaps(*whole, &candidate);
    if (windows_.decide) SetGapsOfWindows(claim, &candidate);
    if (claim == ClaimOf(search_.best.fitted.hypothesis)) {
      const bool closed =
          claim != kAsGiven || Closed(search_.given.held_out_gap(), search_.given.held_out_gap(), false);
      if (!closed) candidate.rejected_because = "it leaves a gap of " + Gap(search_.given.held_out_gap());
      return candidate;
    }
    candidate.rejected_because = WhyOnWindows(claim);
    if (candidate.rejected_because.empty() && whole != nullptr) {
      candidate.rejected_because =
          "held-out gap " + ComparedGaps(whole->held_out_gap(), search_.best.held_out_gap());
    }
    if (candidate.rejected_because.empty()) candidate.rejected_because = "others explain more";
    return candidate;
  }

 private:
  static constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

  static void SetGaps(const Explanation& one, Candidate* candidate) {
    candidate->fit = std::sqrt(one.squared_gap());
    if (!one.blocks.sums.empty()) candidate->held_out = std::sqrt(one.held_out_gap());
  }

  // Where windows decide, the gaps are theirs. Returns how far the fitted sum of squares falls; 0 where the claim was not tried.
  double SetGapsOfWindows(const std::string& claim, Candidate* candidate) const {
    candidate->fit = candidate->held_out = kNan;
    const Explanation* one = BestOf(windows_.tried, claim);
    if (one == nullptr) return 0;
    SetGaps(*one, candidate);
    const Explanation* given = BestOf(windows_.tried, kAsGiven);
    return given == nullptr ? 0 : given->fitted.sum - one->fitted.sum;
  }

  std::string Why(const Rated& rated, const Explanation* alone) const {
    if (!rated.failure.empty()) return "could not be tried: " + rated.failure;
    if (windows_.decide) {
      std::string on_windows = WhyOnWindows(rated.change.Label());
      return on_windows.empty() ? kNotProposed : on_windows;
    }
    const Explanation* on_top = AddedToBest(search_, rated.change);
    if (on_top != nullptr && !search_.best.changes().empty()) {
      return "added to " + search_.best.changes().front().Label() +
             ", it changes the held-out gap only from " + Gap(search_.best.held_out_gap()) + " to " +
             Gap(on_top->held_out_gap());
    }
    if (alone != nullptr && !alone->blocks.sums.empty()) {
      return "held-out gap " + ComparedGaps(alone->held_out_gap(), search_.best.held_out_gap());
    }
    if (alone != nullptr) return "refitted, it leaves a gap of " + Gap(alone->squared_gap());
    return "it was not tried";
  }

  // "" for what was not predicted on windows.
  std::string WhyOnWindows(const std::string& claim) const {
    const Explanation* one = BestOf(windows_.tried, claim);
    if (one == nullptr || std::isnan(best_on_windows_)) return "";
    const std::vector<Change>& found = search_.best.changes();
    const bool adds = !found.empty() && found.size() < one->changes().size() &&
                      std::all_of(found.begin(), found.end(),
                                  [&](const Change& change) { return one->fitted.hypothesis.Has(change); });
    if (adds) {
      return "added to what was found, it changes the gap of windows only from " + Gap(best_on_windows_) +
             " to " + Gap(one->held_out_gap());
    }
    return "the gap of windows is " + ComparedGaps(one->held_out_gap(), best_on_windows_);
  }

  const SearchResult& search_;
  const WindowTrials& windows_;
  double correlation_;
  double best_on_windows_ = kNan;
};

void Sort(std::vector<Candidate>* candidates) {
  const auto order = [](const Candidate& c) {
    const double gap = !std::isnan(c.held_out) ? c.held_out : std::numeric_limits<double>::infinity();
    const double fit = !std::isnan(c.fit) ? c.fit : std::numeric_limits<double>::infinity();
    return std::make_tuple(!c.rejected_because.empty(), -c.weight, gap, fit);
  };
  std::stable_sort(candidates->begin(), candidates->end(),
                   [&](const Candidate& a, const Candidate& b) { return order(a) < order(b); });
}

}  // namespace

std::vector<Candidate> Ranking(const SearchContext& context, const SearchResult& search,
                               const std::map<std::string, double>& weights, const WindowTrials& windows) {
  const Ranker ranker(context, search, windows);
  std::vector<Candidate> candidates;
  std::map<std::string, double> left = weights;
  for (const Rated& rated : search.rated) {
    candidates.push_back(ranker.Single(rated));
    const auto weight = left.find(candidates.back().id);
    if (weight == left.end()) continue;
    candidates.back().weight = weight->second;
    left.erase(weight);
  }
  for (const auto& [claim, weight] : left) {
    candidates.push_back(ranker.Other(claim));
    candidates.back().weight = weight;
  }
  Sort(&candidates);
  return candidates;
}

}  // namespace hydro::diagnose
