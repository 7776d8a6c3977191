#include "diagnose/say/found.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/word_list.h"
#include "diagnose/evidence/change_set.h"
#include "diagnose/fit/closure.h"
#include "diagnose/prove/blind_changes.h"
#include "diagnose/prove/whole_runs.h"
#include "diagnose/say/claims.h"
#include "diagnose/say/found_values.h"
#include "diagnose/say/shown.h"

namespace hydro::diagnose {
namespace {

constexpr double kUnsaid = std::numeric_limits<double>::quiet_NaN();
// Standard errors: 95 % of a normal distribution lie within.
constexpr double kToldApart = 2;

FoundEffect Describe(const Change& change, const model::ModelDescription& model,
                     const std::vector<FreeParameter>& free, const std::vector<Interval>& intervals) {
  const model::EffectInfo& info = *model::FindEffect(change.effect);
  FoundEffect found;
  found.id = info.id;
  found.summary = info.summary;
  found.equation = info.equation;
  for (const auto& [name, value] : change.names) found.names.push_back(name + " = " + value);
  const auto effect = std::ranges::find_if(model.effects, [&](const auto& one) { return one.id == info.id; });
  for (const model::ParameterInfo& parameter : info.parameters) {
    const auto fitted = std::ranges::find_if(
        free, [&](const FreeParameter& one) { return one.name == info.id + "." + parameter.name; });
    if (fitted != free.end()) {
      const Interval& interval = intervals[static_cast<size_t>(fitted - free.begin())];
      found.parameters.push_back(
          {parameter.name, fitted->value, interval.low, interval.high, fitted->unit, true});
      JudgeInterval(parameter, &found.parameters.back());
    } else if (parameter.role == model::Role::kPeriods && effect != model.effects.end()) {
      const double whole = effect->parameters.at(parameter.name);
      found.parameters.push_back({parameter.name, whole, whole, whole, parameter.UnitIn(model.units), true});
    }
  }
  return found;
}

// The typical squared gap of the windows without these effects of the best set; NaN where no such set was
// proved.
double GapWithout(const Proof& proof, const std::vector<Change>& effects) {
  std::vector<Change> others = proof.Best().Effects();
  for (const Change& change : effects) std::erase(others, change);
  const size_t place = BestWithEffects(proof.sets, others);
  return place < proof.sets.size() ? TypicalGap(proof.sets[place].near) : kUnsaid;
}

double ShareOf(const Proof& proof, const Change& change) {
  const double with = TypicalGap(proof.Best().near), without = GapWithout(proof, {change});
  const double of_values = GapWithout(proof, proof.Best().Effects());
  const double to_take = std::isnan(of_values) ? without : of_values;
  if (!(to_take > 1) || std::isnan(without)) return kUnsaid;
  return std::clamp((without - std::max(1.0, with)) / (to_take - 1), 0.0, 1.0);
}

// The closures, with the typical gap over windows with and without them.
std::vector<Closure> DescribeClosures(const Proof& proof, const std::vector<Interval>& intervals) {
  std::vector<Closure> closures = FoundClosures(proof.Found(), intervals);
  std::vector<Change> curves = proof.Best().Effects();
  std::erase_if(curves, [](const Change& change) { return !IsClosureEffect(change.effect); });
  for (Closure& closure : closures) {
    closure.before = std::sqrt(GapWithout(proof, curves));
    closure.after = std::sqrt(TypicalGap(proof.Best().near));
    closure.seconds = proof.seconds;
  }
  return closures;
}

// What the set has instead of the best set's effects: effects or, where it has none at all, its values. "" if
// nothing.
std::string InPlace(const ProvedSet& other, const ProvedSet& best) {
  const std::vector<Change> effects = other.Effects();
  if (effects.empty()) {
    const std::string claim = ClaimOf(other.hypothesis);
    return claim == kAsGiven ? "" : claim;
  }
  std::vector<std::string> labels;
  for (const Change& change : effects) {
    if (!best.hypothesis.Has(change)) labels.push_back(change.Label());
  }
  return Joined(labels, " + ");
}

// Whether the set is an explanation that may be true. A curve can imitate most effects, so that its equally
// good fit is no reason to doubt their names.
bool MayBeTrue(const ProvedSet& set, const Diagnosis& d) {
  if (set.HasCurve()) return false;
  if (d.explanations.empty()) return true;
  const std::vector<Change> effects = set.Effects();
  const bool unseen =
      std::ranges::any_of(effects, [](const Change& change) { return IsUnseenByBalances(change.effect); });
  if (unseen) return true;
  const std::string claim = ClaimOf(set.hypothesis);
  for (size_t i = 0; i < std::min(d.set_90, d.explanations.size()); ++i) {
    const std::string said = ClaimOfSet(d.explanations[i].changes);
    // No balance holds its values: the set without changes is also the set of other values.
    if (said == claim || (said == kAsGiven && effects.empty())) return true;
  }
  return false;
}

// The weight of what one set has and another has not: that of its least likely effect. What balances cannot
// see has the odds of any effect.
double WeightBeyond(const ProvedSet& set, const ProvedSet& other, const Diagnosis& d) {
  double least = 1;
  for (const Change& change : set.Effects()) {
    if (other.hypothesis.Has(change)) continue;
    const double unseen = IsUnseenByBalances(change.effect) ? kOddsOfAChange : 0;
    least = std::min(least, std::max(unseen, WeightOf(change, d.explanations)));
  }
  return least;
}

// What the set has to gain more than the best one, because the balances hold it to be less likely: an effect
// that does nothing explains nothing.
double Dearer(const ProvedSet& other, const ProvedSet& best, const Diagnosis& d) {
  if (other.Effects().empty()) return std::max(0.0, other.price - best.price);
  const double rival = std::max(1 / kMostOdds, WeightBeyond(other, best, d)),
               own = WeightBeyond(best, other, d);
  return FallWorth(std::max(0.0, std::log(std::max(own, 1 / kMostOdds) / rival)));
}

// The places of sets that explain as much without the change.
std::vector<size_t> TiesOf(const Change& change, const Proof& proof, const Diagnosis& d) {
  std::vector<size_t> ties;
  for (size_t i = 0; i < proof.sets.size(); ++i) {
    const ProvedSet& other = proof.sets[i];
    if (!other.tested() || other.hypothesis.Has(change)) continue;
    // Two or three runs scatter too much to tell sets apart, but what leaves most of the gap replaces
    // nothing.
    if (!proof.OnWindows() && !TakesMost(proof.Given(), other)) continue;
    // The windows and the balances together have to distinguish sets that may be true, by nine to one, or by
    // twice the error of the windows. Values alone may be true whatever the balances say, unless the
    // windows support the effect at all.
    const bool may_be = MayBeTrue(other, d);
    if (!may_be && !other.Effects().empty()) continue;
    const GapFall fall = FallOf(other.near, proof.Best().near);
    const double told_apart = std::max(may_be ? kEven : kEqual, (may_be ? kToldApart : 1) * fall.error);
    if (fall.windows > 0 && fall.logarithm + Dearer(other, proof.Best(), d) > told_apart) continue;
    if (!InPlace(other, proof.Best()).empty()) ties.push_back(i);
  }
  return ties;
}

}  // namespace

std::vector<model::ModelDescription> DescribeFound(const ProofContext& context, const Proof& proof,
                                                   Diagnosis* d) {
  const std::vector<FreeParameter> free = proof.Found().Free();
  const std::vector<Interval> intervals = IntervalsOf(context, proof);
  std::vector<model::ModelDescription> models = {proof.Found().model};
  for (const Change& change : proof.Best().Effects()) {
    if (IsClosureEffect(change.effect)) continue;
    FoundEffect found = Describe(change, proof.Found().model, free, intervals);
    found.share = ShareOf(proof, change);
    found.weight = WeightOf(change, d->explanations);
    for (const size_t place : TiesOf(change, proof, *d)) {
      const std::string label = InPlace(proof.sets[place], proof.Best());
      const bool there = std::ranges::find(found.tied_with, label) != found.tied_with.end();
      if (there) continue;
      found.tied_with.push_back(label);
      models.push_back(proof.sets[place].hypothesis.model);
    }
    d->effects.push_back(std::move(found));
  }
  d->closures = DescribeClosures(proof, intervals);
  DescribeValues(context, proof, intervals, d);
  return models;
}

}  // namespace hydro::diagnose
