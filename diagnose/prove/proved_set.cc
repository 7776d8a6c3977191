#include "diagnose/prove/proved_set.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "base/maths/spread.h"
#include "diagnose/fit/closure.h"
#include "diagnose/prove/proof_context.h"

namespace hydro::diagnose {
namespace {

double MedianLogarithm(const std::vector<WindowGap>& gaps) {
  std::vector<double> logarithms;
  for (const WindowGap& gap : gaps) {
    if (gap.tested) logarithms.push_back(LogarithmOf(gap.Typical()));
  }
  return maths::Median(std::move(logarithms));
}

// The best of the admitted sets. They are ordered by the median, which needs no comparison, and then compared
// with the best so far, because differences count only up to a limit. Returns `none` when no set is admitted.
size_t BestSet(const std::vector<ProvedSet>& sets, const std::function<bool(const ProvedSet&)>& admitted) {
  const size_t none = sets.size();
  size_t best = none;
  for (size_t i = 0; i < sets.size(); ++i) {
    if (!sets[i].tested() || !admitted(sets[i])) continue;
    if (best == none || MedianLogarithm(sets[i].near) < MedianLogarithm(sets[best].near)) best = i;
  }
  std::vector<bool> was_best(sets.size());
  while (best != none && !was_best[best]) {
    was_best[best] = true;
    const ProvedSet& reference = sets[best];
    double most = 0;
    for (size_t i = 0; i < sets.size(); ++i) {
      if (!sets[i].tested() || !admitted(sets[i])) continue;
      const double worth = WorthOf(reference, sets[i]).logarithm;
      const bool likelier = std::abs(worth - most) <= kEqual && sets[i].weight > sets[best].weight;
      if (worth <= most + kEqual && !likelier) continue;
      most = std::max(most, worth);
      best = i;
    }
  }
  return best;
}

}  // namespace

std::vector<Change> ProvedSet::Effects() const {
  std::vector<Change> effects;
  for (const Change& change : hypothesis.changes) {
    if (!change.effect.empty()) effects.push_back(change);
  }
  return effects;
}

bool ProvedSet::HasCurve() const {
  return std::ranges::any_of(hypothesis.changes,
                             [](const Change& change) { return IsClosureEffect(change.effect); });
}

void JudgeSet(const ProofWindows& windows, int jobs, ProvedSet* set) {
  const auto model = [set](size_t run) -> const model::ModelDescription& { return set->ModelOf(run); };
  set->near = GapsOfWindows(model, windows.near, jobs);
  set->far.clear();
}

void JudgeFar(const ProofWindows& windows, int jobs, ProvedSet* set) {
  const auto model = [set](size_t run) -> const model::ModelDescription& { return set->ModelOf(run); };
  if (set->far.empty()) set->far = GapsOfWindows(model, windows.far, jobs);
}

bool PredictsBetter(const ProofWindows& windows, int jobs, ProvedSet* other, ProvedSet* set) {
  if (!PredictsBetter(*other, *set)) return false;
  JudgeFar(windows, jobs, other);
  JudgeFar(windows, jobs, set);
  return PredictsBetter(*other, *set);
}

bool PredictsBetter(const ProvedSet& other, const ProvedSet& set) {
  if (!other.tested()) return false;
  if (!set.tested()) return true;
  const GapFall far = FallOf(set.far, other.far), near = FallOf(set.near, other.near);
  return near.Exceeds(0) && far.logarithm >= -far.error;
}

GapFall WorthOf(const ProvedSet& from, const ProvedSet& to) {
  GapFall worth = FallOf(from.near, to.near);
  worth.logarithm -= to.price - from.price;
  return worth;
}

double PriceOf(double weight) {
  const double odds = std::clamp(weight / std::max(1 - weight, 1e-9), 1 / kMostOdds, kMostOdds);
  return kEven - FallWorth(std::log(odds));
}

double FallWorth(double log_odds) { return kEven * log_odds / std::log(kWorthIt); }

double LogOddsOf(double fall) { return fall / kEven * std::log(kWorthIt); }

bool IsEffectKept(const ProvedSet& with, const ProvedSet& without, double price) {
  if (!with.tested() || !without.tested()) return true;
  const GapFall near = FallOf(without.near, with.near);
  if (near.windows == 0) return true;
  return near.logarithm - near.error >= price && !FallOf(with.far, without.far).Exceeds(kPartOfAnEffect);
}

bool AreValuesKept(const ProvedSet& with, const ProvedSet& as_given) {
  if (!with.tested() || !as_given.tested()) return true;
  const GapFall near = FallOf(as_given.near, with.near);
  return near.windows == 0 ||
         (near.Exceeds(kPartOfValues) && !FallOf(with.far, as_given.far).Exceeds(kPartOfAnEffect));
}

bool TakesNextToNothing(const ProvedSet& with, const ProvedSet& without, const ProvedSet& values) {
  // Of the squared gap: no machine's equations are true to better than a hundredth.
  constexpr double kLeastShare = 0.01;
  if (!with.tested() || !without.tested() || !values.tested()) return false;
  const double left = TypicalGap(with.near), taken = TypicalGap(without.near) - left;
  return left > kNoiseAndAsMuchAgain && taken < kLeastShare * (TypicalGap(values.near) - 1);
}

size_t LeadingSet(const std::vector<ProvedSet>& sets) {
  return BestSet(sets, [](const ProvedSet&) { return true; });
}

std::vector<size_t> WorthRefining(const std::vector<ProvedSet>& sets, size_t most) {
  const size_t leading = LeadingSet(sets);
  if (leading >= sets.size()) return {};
  std::vector<size_t> values, others;
  for (size_t i = 0; i < sets.size(); ++i) {
    if (!sets[i].tested() || sets[i].hypothesis.Free().empty()) continue;
    (sets[i].Effects().empty() ? values : others).push_back(i);
  }
  std::ranges::stable_sort(others, [&](size_t a, size_t b) {
    return WorthOf(sets[leading], sets[a]).logarithm > WorthOf(sets[leading], sets[b]).logarithm;
  });
  others.resize(std::min(others.size(), most));
  values.insert(values.end(), others.begin(), others.end());
  std::ranges::sort(values);
  return values;
}

size_t BestWithEffects(const std::vector<ProvedSet>& sets, const std::vector<Change>& effects) {
  return BestSet(sets, [&](const ProvedSet& set) {
    const std::vector<Change> own = set.Effects();
    return std::is_permutation(own.begin(), own.end(), effects.begin(), effects.end());
  });
}

}  // namespace hydro::diagnose
