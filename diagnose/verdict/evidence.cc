#include "diagnose/verdict/evidence.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/word_list.h"

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

// As Change::Label(): "sensor.skew (p1)".
std::string LabelOf(const std::string& change) {
  const size_t names = change.find('(');
  if (names == std::string::npos || change.starts_with("closure.")) return change;
  return change.substr(0, names) + " " + change.substr(names);
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

const Explanation* OnWindowsOf(const WindowTrials& windows, const Hypothesis& best) {
  const Explanation* found = nullptr;
  for (const Explanation& one : windows.tried) {
    if (!one.fitted.ok() || one.blocks.sums.empty()) continue;
    if (!one.fitted.hypothesis.FreesTheSame(best) || !SameChanges(one.fitted.hypothesis, best)) continue;
    if (found == nullptr || one.held_out_gap() < found->held_out_gap()) found = &one;
  }
  return found != nullptr ? found : BestOf(windows.tried, ClaimOf(best));
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

std::string ClaimOfSet(const std::vector<std::string>& changes) {
  std::vector<std::string> effects, values;
  for (const std::string& change : changes) {
    const bool value = change.starts_with("value.");
    if (value || change.starts_with("run.")) {
      values.push_back(value ? "parameter " + change.substr(change.find('.') + 1) : change);
    } else {
      effects.push_back(LabelOf(change));
    }
  }
  std::vector<std::string>& said = effects.empty() ? values : effects;
  std::sort(said.begin(), said.end());
  return said.empty() ? kAsGiven : Joined(said, " + ");
}

std::map<std::string, double> WeightsOf(const SearchContext& context, const WideSearch& found,
                                        const std::vector<WeightedSet>& explanations) {
  const std::string claim = ClaimOf(found.search.best.fitted.hypothesis);
  std::map<std::string, double> weights;
  for (const WeightedSet& one : explanations) {
    std::string said = ClaimOfSet(one.changes);
    // No balance holds its values: where the model as given does not do, the set without changes is that of other values.
    if (said == kAsGiven && claim == kAllValues) said = claim;
    weights[said] += one.weight;
  }
  if (weights.count(claim) > 0) return weights;
  return Weights(DecidingContest(context, found.search, found.refit, found.windows), context.seed);
}

}  // namespace hydro::diagnose
