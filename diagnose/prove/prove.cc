#include "diagnose/prove/prove.h"

#include <algorithm>
#include <utility>

#include "diagnose/fit/closure.h"
#include "diagnose/prove/proof_context.h"
#include "diagnose/prove/proof_sets.h"
#include "diagnose/prove/refined_values.h"
#include "diagnose/prove/whole_runs.h"

namespace hydro::diagnose {

namespace {

constexpr size_t kGiven = ProofSets::kGiven;
// The number of proposals whose values are refined: a scan is useful only if the truth is among its first
// five.
constexpr size_t kMostRefined = 5;

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

bool HasACurve(const ProvedSet& set) {
  const std::vector<Change> effects = set.Effects();
  return std::any_of(effects.begin(), effects.end(),
                     [](const Change& change) { return IsClosureEffect(change.effect); });
}

// Chooses among the sets.
class Prover {
 public:
  explicit Prover(ProofSets* sets) : sets_(*sets) {}

  bool IsKept(size_t with, size_t without, double price) {
    return IsEffectKept(sets_[with], sets_[without], price) &&
           IsEffectKept(sets_.Far(with), sets_.Far(without), price);
  }

  // The best set that remains when one unneeded effect is left out; the set itself where all are needed.
  size_t Reduced(size_t place) {
    size_t reduced = place;
    double least = 0;
    for (const Change& change : sets_[place].Effects()) {
      const size_t without = sets_.Without(place, change);
      const double price = sets_.PriceOf(change);
      if (without >= sets_.size() || IsKept(place, without, price)) continue;
      const double lost = FallOf(sets_[without].near, sets_[place].near).logarithm - price;
      if (reduced != place && lost >= least) continue;
      reduced = without;
      least = lost;
    }
    return reduced;
  }

  size_t Choice() {
    size_t best = LeadingSet(sets_.all());
    if (best >= sets_.size()) return kGiven;
    std::vector<size_t> led;  // comparisons of three sets may cycle, so each leads once
    for (size_t next = best; std::find(led.begin(), led.end(), next) == led.end();) {
      best = next;
      led.push_back(best);
      sets_.Refine(best);
      next = Reduced(best);
      if (next == best) next = BetterOfTheSameSize(best);
    }
    best = WithFewerNumbers(best);
    const bool has_effects = !sets_[best].Effects().empty();
    if (!has_effects && best != kGiven && !AreValuesKept(sets_[best], sets_[kGiven])) best = kGiven;
    return best;
  }

  // Among sets with equally many effects and equal worth, prefers the one whose effects have the fewest
  // numbers: a bias has one, an asymmetry two.
  size_t WithFewerNumbers(size_t place) const {
    size_t fewest = place;
    for (size_t i = 0; i < sets_.size(); ++i) {
      if (!sets_[i].tested() || sets_[i].Effects().size() != sets_[place].Effects().size()) continue;
      if (sets_[i].Effects().empty() || NumbersOf(sets_[i]) >= NumbersOf(sets_[fewest])) continue;
      const GapFall worth = WorthOf(sets_[i], sets_[place]);
      // A curve fits anything, so it has to gain as much more as an effect.
      const bool curve = HasACurve(sets_[place]) && !HasACurve(sets_[i]);
      if (worth.logarithm <= std::max(curve ? kPartOfAnEffect : kPartOfValues, worth.error)) fewest = i;
    }
    return fewest;
  }

  // The chosen set must not be worse than another set with as few effects.
  size_t BetterOfTheSameSize(size_t place) const {
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

  bool LeavesAGap(size_t place) const {
    return !TimeIsUp(sets_.context()) && sets_[place].Effects().size() < static_cast<size_t>(kMostChanges) &&
           TypicalGap(sets_[place].near) > kCloseEnough;
  }

  void Race(size_t from, const std::vector<Change>& blind) {
    if (!sets_.has_fitted()) return;
    for (const Change& change : blind) {
      const std::vector<model::EffectDescription>& effects = sets_[from].hypothesis.model.effects;
      const bool there = std::any_of(effects.begin(), effects.end(),
                                     [&](const auto& effect) { return effect.id == change.effect; });
      if (!there && !TimeIsUp(sets_.context())) sets_.Race(from, change);
    }
  }

  // Takes the same effects with the given base values where they predict as well. Then no value is called
  // wrong.
  size_t TakeGivenValues(size_t place) {
    if (sets_[place].Effects().empty() || sets_[place].hypothesis.base.empty()) return place;
    const size_t sparse = sets_.WithGivenValues(place);
    const bool values = AreValuesKept(sets_[place], sets_[sparse]);
    return values || !sets_[sparse].tested() ? place : sparse;
  }

  // Adds the effect that the balances find more likely than not, where windows neither confirm nor deny it: a
  // small error of a gain, or a ripple, hardly changes predictions over the length of a window. Both
  // witnesses together have to speak for it. The effect is reported as tied with the set that does without
  // it.
  size_t WithWhatBalancesSay(size_t place) const {
    size_t with = place;
    double most = 0.5;
    for (size_t i = 0; i < sets_.size(); ++i) {
      if (!sets_[i].tested() || HasACurve(sets_[i])) continue;
      const std::vector<Change> more = Beyond(sets_[i], sets_[place]);
      if (more.size() != 1 || sets_[i].Effects().size() != sets_[place].Effects().size() + 1) continue;
      const double said = sets_.SaidOf(more.front());
      const GapFall fall = FallOf(sets_[place].near, sets_[i].near);
      const double values = sets_[i].price_of_values - sets_[place].price_of_values;
      const bool paid = fall.logarithm >= sets_.PriceOf(more.front()) + values;
      if (said <= most || !paid || fall.logarithm < -std::max(kEqual, fall.error)) continue;
      most = said;
      with = i;
    }
    return with;
  }

  size_t BestValues() const {
    const size_t best = BestWithEffects(sets_.all(), {});
    if (best < sets_.size() && best != kGiven) return best;
    for (size_t i = 1; i < sets_.size(); ++i) {
      // The given values are among those that a refit may have.
      if (sets_[i].Effects().empty() && PredictsBetter(sets_[i], sets_[kGiven])) return i;
    }
    return kGiven;
  }

 private:
  ProofSets& sets_;
};

// The proof to report when this set predicts best, with its numbers as precise as possible.
Proof Reported(ProofSets* sets, const Prover& prover, size_t best) {
  const ProofContext& context = sets->context();
  sets->SetFitted(best);
  sets->RefineForReport(best);
  context.Report("fitting the whole runs", 0.93);
  const ProofWindows& windows = sets->windows();
  std::vector<RunData> told = WithDiscrepancy(windows.told, (*sets)[best].hypothesis.model, context.jobs);
  // Where other values are all that was found, they are the best ones: a reader sees one refit, not two.
  const bool values_alone = best != ProofSets::kGiven && (*sets)[best].Effects().empty();
  return ProofOf(context, windows, std::move(told), sets->all(),
                 {ProofSets::kGiven, values_alone ? best : prover.BestValues(), best});
}

// The place of the best set without an effect that may be absent and that the windows do not show either; if
// there is no such effect, the place of the best set. Amounts that can replace each other may each be 0, but
// not both: then the windows do show the effect.
size_t WithoutWhatIsNotShown(ProofSets* sets, const Proof& proof) {
  for (const Change& change : MayBeNone(sets->context(), proof)) {
    const size_t without = sets->Without(proof.best, change);
    if (without >= sets->size() || without == proof.best) continue;
    const GapFall fall = FallOf((*sets)[without].near, (*sets)[proof.best].near);
    if (!fall.Exceeds(kPartOfValues)) return without;
  }
  return proof.best;
}

}  // namespace

Proof ProveProposals(const ProofContext& context, const Hypothesis& as_given,
                     const std::vector<size_t>& allowed, const std::vector<Proposal>& proposals,
                     const std::vector<Change>& blind, const SaidByBalances& said) {
  context.Report("simulating the proposals", 0.85);
  ProofSets sets(context, as_given, allowed, said);
  sets.Add(proposals);
  sets.SetFitted(LeadingSet(sets.all()));
  context.Report("refining their values", 0.88);
  for (const size_t i : WorthRefining(sets.all(), 0)) sets.Refine(i);
  sets.BeginAtBestValues();
  for (const size_t i : WorthRefining(sets.all(), kMostRefined)) sets.Refine(i);
  Prover prover(&sets);
  size_t best = prover.Choice();
  if (prover.LeavesAGap(best)) {
    context.Report("what balances cannot show", 0.91);
    prover.Race(best, blind);
    // An effect that substitutes for one of them may be in its way.
    if (!sets[best].Effects().empty()) prover.Race(prover.BestValues(), blind);
    best = prover.Choice();
  }
  best = prover.WithWhatBalancesSay(prover.TakeGivenValues(best));
  Proof proof = Reported(&sets, prover, best);
  for (size_t shown = best; (shown = WithoutWhatIsNotShown(&sets, proof)) != best;) {
    best = shown;
    proof = Reported(&sets, prover, best);
  }
  // The remainder beside the noise is no larger than the noise itself: windows are too short for what is
  // left, if anything is.
  const bool at_the_noise = TypicalGap(proof.Best().near) < 2;
  return ProvedOnWholeRuns(context, as_given, std::move(proof), at_the_noise, said.unlikely);
}

}  // namespace hydro::diagnose
