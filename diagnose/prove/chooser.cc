#include "diagnose/prove/chooser.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "diagnose/prove/proof_context.h"

namespace hydro::diagnose {
namespace {

constexpr size_t kGiven = ProofSets::kGiven;

// The number of parameters that the set adds to the model.
size_t NumbersOf(const ProvedSet& set) {
  size_t numbers = 0;
  for (const Change& change : set.Effects()) {
    for (const model::EffectDescription& effect : set.hypothesis.model.effects) {
      if (effect.id != change.effect) continue;
      numbers += effect.parameters.size();
      const auto values = effect.lists.find("values");
      numbers += values == effect.lists.end() ? 0 : values->second.size();
    }
  }
  return numbers;
}

// The effects of `set` that `other` lacks.
std::vector<Change> Beyond(const ProvedSet& set, const ProvedSet& other) {
  std::vector<Change> effects = set.Effects();
  std::erase_if(effects, [&](const Change& change) { return other.hypothesis.Has(change); });
  return effects;
}

}  // namespace

bool Chooser::IsKept(size_t with, size_t without, double price) {
  return IsEffectKept(sets_[with], sets_[without], price) &&
         IsEffectKept(sets_.Far(with), sets_.Far(without), price);
}

size_t Chooser::Reduced(size_t place) {
  using Values = ProofSets::Values;
  std::vector<std::pair<double, Change>> needed;  // with what is lost without them
  size_t reduced = place;
  double least = std::numeric_limits<double>::infinity();
  for (const Change& change : sets_[place].Effects()) {
    const size_t without = sets_.Without(place, change, Values::kAsTheyAre);
    if (without >= sets_.size()) continue;
    const double price = sets_.PriceOf(change);
    const double lost = FallOf(sets_[without].near, sets_[place].near).logarithm - price;
    needed.emplace_back(lost, change);
    if (IsKept(place, without, price) || lost >= least) continue;
    reduced = without;
    least = lost;
  }
  if (reduced != place) return reduced;
  std::ranges::stable_sort(needed, [](const auto& a, const auto& b) { return a.first < b.first; });
  for (const auto& [lost, change] : needed) {
    const size_t without = sets_.Without(place, change, Values::kRefined);
    if (!IsKept(place, without, sets_.PriceOf(change))) return without;
  }
  return place;
}

size_t Chooser::Choice() {
  size_t best = LeadingSet(sets_.all());
  if (best >= sets_.size()) return kGiven;
  std::vector<size_t> led;  // comparisons of three sets may cycle, so each leads once
  for (size_t next = best; std::ranges::find(led, next) == led.end();) {
    best = next;
    led.push_back(best);
    sets_.Refine(best);
    next = Reduced(best);
    if (next == best) next = BetterOfTheSameSize(best);
  }
  best = WithFewerNumbers(best);
  const bool has_effects = !sets_[best].Effects().empty();
  if (!has_effects && best != kGiven && !AreValuesKept(sets_.Far(best), sets_.Far(kGiven))) best = kGiven;
  return best;
}

size_t Chooser::WithFewerNumbers(size_t place) const {
  size_t fewest = place;
  for (size_t i = 0; i < sets_.size(); ++i) {
    if (!sets_[i].tested() || sets_[i].Effects().size() != sets_[place].Effects().size()) continue;
    if (sets_[i].Effects().empty() || NumbersOf(sets_[i]) >= NumbersOf(sets_[fewest])) continue;
    const GapFall worth = WorthOf(sets_[i], sets_[place]);
    // A curve fits anything, so it has to gain as much more as an effect.
    const bool curve = sets_[place].HasCurve() && !sets_[i].HasCurve();
    if (worth.logarithm <= std::max(curve ? kPartOfAnEffect : kPartOfValues, worth.error)) fewest = i;
  }
  return fewest;
}

size_t Chooser::BetterOfTheSameSize(size_t place) const {
  size_t better = place;
  double most = kEqual;
  for (size_t i = 0; i < sets_.size(); ++i) {
    if (!sets_[i].tested() || sets_[i].Effects().size() > sets_[place].Effects().size()) continue;
    const double worth = WorthOf(sets_[place], sets_[i]).logarithm;
    if (worth <= most) continue;
    most = worth;
    better = i;
  }
  return better;
}

bool Chooser::LeavesAGap(size_t place) const {
  return !TimeIsUp(sets_.context()) && sets_[place].Effects().size() < static_cast<size_t>(kMostChanges) &&
         TypicalGap(sets_[place].near) > kCloseEnough;
}

void Chooser::Race(size_t from, const std::vector<Change>& blind) {
  if (!sets_.has_fitted()) return;
  for (const Change& change : blind) {
    // Values that stand in for an effect lead its fit astray, as a J that carries the load behind a play.
    const bool values = sets_[from].Effects().empty() && model::FindEffect(change.effect)->on_request;
    const std::vector<model::EffectDescription>& effects = sets_[from].hypothesis.model.effects;
    const bool there =
        std::ranges::any_of(effects, [&](const auto& effect) { return effect.id == change.effect; });
    if (!there && !TimeIsUp(sets_.context())) sets_.Race(values ? kGiven : from, change);
  }
}

size_t Chooser::TakeGivenValues(size_t place) {
  if (sets_[place].Effects().empty() || sets_[place].hypothesis.base.empty()) return place;
  const size_t sparse = sets_.WithGivenValues(place);
  const bool values = AreValuesKept(sets_[place], sets_[sparse]);
  return values || !sets_[sparse].tested() ? place : sparse;
}

size_t Chooser::OneNumberForManyValues(size_t place) {
  if (place == kGiven || !sets_[place].Effects().empty()) return place;
  size_t one = place;
  for (size_t i = 0, size = sets_.size(); i < size; ++i) {
    const bool single = sets_[i].tested() && sets_[i].Effects().size() == 1 && !sets_[i].HasCurve();
    if (!single || NumbersOf(sets_[i]) != 1 || sets_[place].hypothesis.base.size() < 2) continue;
    // With its own values no better than this, it is none with given ones.
    if (!IsAlike(place, i)) continue;
    const size_t sparse = sets_.WithGivenValues(i);
    if (sets_[sparse].tested() && IsAlike(one, sparse)) one = sparse;
  }
  return one;
}

size_t Chooser::WithWhatBalancesSay(size_t place) const {
  size_t with = place;
  double most = 0.5;
  for (size_t i = 0; i < sets_.size(); ++i) {
    if (!sets_[i].tested() || sets_[i].HasCurve()) continue;
    const std::vector<Change> more = Beyond(sets_[i], sets_[place]);
    if (more.size() != 1 || sets_[i].Effects().size() != sets_[place].Effects().size() + 1) continue;
    const double said = sets_.SaidOf(more.front());
    const GapFall fall = FallOf(sets_[place].near, sets_[i].near);
    const bool paid = fall.logarithm >= sets_.PriceOf(more.front());
    if (said <= most || !paid || fall.logarithm < -std::max(kEqual, fall.error)) continue;
    most = said;
    with = i;
  }
  return with;
}

size_t Chooser::BestValues() const {
  const size_t best = BestWithEffects(sets_.all(), {});
  if (best < sets_.size() && best != kGiven) return best;
  for (size_t i = 1; i < sets_.size(); ++i) {
    // The given values are among those that a refit may have.
    if (sets_[i].Effects().empty() && PredictsBetter(sets_[i], sets_[kGiven])) return i;
  }
  return kGiven;
}

bool Chooser::IsAlike(size_t place, size_t set) const {
  const GapFall fall = FallOf(sets_[place].near, sets_[set].near);
  return fall.logarithm >= -std::max(kEqual, fall.error) || TypicalGap(sets_[set].near) <= kCloseEnough;
}

}  // namespace hydro::diagnose
