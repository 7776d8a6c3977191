#include "diagnose/verdict/evidence.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/word_list.h"
#include "diagnose/search/proof.h"

namespace hydro::diagnose {

namespace {

constexpr char kAllValues[] = "parameters";

std::vector<std::string> PartsOf(const Hypothesis& hypothesis) {
  std::vector<std::string> parts;
  for (const Change& change : hypothesis.changes) {
    if (!change.effect.empty()) parts.push_back(change.Label());
  }
  for (const size_t i : hypothesis.base) parts.push_back(model::BaseParameters()[i].info.name);
  for (const std::string& id : hypothesis.effects) {
    const bool new_effect = std::any_of(hypothesis.changes.begin(), hypothesis.changes.end(),
                                        [&](const Change& change) { return change.effect == id; });
    if (!new_effect) parts.push_back("values of " + id);
  }
  std::sort(parts.begin(), parts.end());
  return parts;
}

std::vector<std::string> RunOfEachBlock(const std::vector<const RunData*>& runs, size_t blocks) {
  std::vector<std::string> names;
  names.reserve(blocks);
  for (size_t b = 0; b < blocks; ++b) names.push_back(runs[b * runs.size() / blocks]->name);
  return names;
}

// Drops what is materially behind the best on windows.
void KeepLeading(const WindowTrials& windows, std::map<std::string, double>* weights) {
  const double least = LeastGap(windows.tried);
  for (auto& [claim, weight] : *weights) {
    const Explanation* one = BestOf(windows.tried, claim);
    if (one != nullptr && Material(one->held_out_gap(), least)) weight = 0;
  }
}

}  // namespace

std::vector<const Explanation*> PointersToAll(const std::vector<Explanation>& tried) {
  std::vector<const Explanation*> all;
  all.reserve(tried.size());
  for (const Explanation& one : tried) all.push_back(&one);
  return all;
}

std::string ClaimOf(const Hypothesis& hypothesis) {
  std::vector<std::string> said;
  for (const Change& change : hypothesis.changes) {
    if (!change.effect.empty()) said.push_back(change.Label());
  }
  if (said.empty()) {
    if (hypothesis.base.size() + hypothesis.effects.size() > static_cast<size_t>(kMostChanges))
      return kAllValues;
    for (const size_t i : hypothesis.base)
      said.push_back("parameter " + model::BaseParameters()[i].info.name);
    for (const std::string& id : hypothesis.effects) said.push_back("parameters of " + id);
  }
  std::sort(said.begin(), said.end());
  return said.empty() ? kAsGiven : Joined(said, " + ");
}

const Explanation* BestOf(const std::vector<Explanation>& tried, const std::string& claim) {
  const Explanation* best = nullptr;
  for (const Explanation& one : tried) {
    if (one.blocks.sums.empty() || ClaimOf(one.fitted.hypothesis) != claim) continue;
    if (best == nullptr || one.held_out_gap() < best->held_out_gap()) best = &one;
  }
  return best;
}

double LeastGap(const std::vector<Explanation>& tried) {
  double least = std::numeric_limits<double>::infinity();
  for (const Explanation& one : tried) {
    if (!one.blocks.sums.empty()) least = std::min(least, one.held_out_gap());
  }
  return least;
}

Contest ContestOf(const std::vector<const Explanation*>& tried, const std::vector<std::string>& runs) {
  Contest contest;
  contest.runs = runs;
  for (const Explanation* one : tried) {
    const std::vector<double>& sums = one->blocks.sums;
    if (!one->fitted.ok() || sums.size() != runs.size() || sums.empty()) continue;
    contest.geometric = one->windows;
    Evidence evidence{ClaimOf(one->fitted.hypothesis), PartsOf(one->fitted.hypothesis),
                      NumbersFactor(one->fitted.hypothesis), sums};
    const double of_a_block = one->blocks.count / static_cast<double>(sums.size());
    for (double& value : evidence.squared_gaps) {
      value = one->windows ? std::exp(value) : value / of_a_block;
    }
    contest.evidence.push_back(std::move(evidence));
  }
  return contest;
}

Contest DecidingContest(const SearchContext& context, const SearchResult& search, const Explanation& refit,
                        const WindowTrials& windows) {
  if (windows.decide) return ContestOf(PointersToAll(windows.tried), windows.runs);
  std::vector<const Explanation*> whole = PointersToAll(search.tried);
  for (const Explanation* one : {&search.given, &search.best, &refit}) whole.push_back(one);
  return ContestOf(whole, RunOfEachBlock(context.predicted(), search.given.blocks.sums.size()));
}

std::map<std::string, double> WeightsOf(const SearchContext& context, const SearchResult& search,
                                        const Explanation& refit, const WindowTrials& windows) {
  std::map<std::string, double> near =
      Weights(ContestOf(PointersToAll(windows.tried), windows.runs), context.seed);
  if (!near.empty() && LeastGap(windows.tried) >= kOutOfReach) return near;
  // Where whole runs are explained to the noise, what is behind on windows and was not proved for it has no part.
  if (search.best.held_out_gap() < kCloseEnough) KeepLeading(windows, &near);
  WindowTrials none;
  return Refined(near, Weights(DecidingContest(context, search, refit, none), context.seed));
}

}  // namespace hydro::diagnose
