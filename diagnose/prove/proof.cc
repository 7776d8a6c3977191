#include "diagnose/prove/proof.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "diagnose/balances/effect_variants.h"
#include "diagnose/fit/closure.h"
#include "diagnose/fit/fit.h"
#include "diagnose/prove/refined_values.h"

namespace hydro::diagnose {
namespace {

// The windows' fit at the best set's values, which leave these gaps, with derivatives and prior knowledge.
Fitted WithDerivatives(const ProofContext& context, const Hypothesis& best,
                       const std::vector<const RunData*>& windows, const std::vector<WindowGap>& gaps) {
  FitOptions held;
  held.most_iterations = 0;
  held.jobs = context.jobs;
  std::vector<model::StartState> starts;
  double sum = 0;
  for (const WindowGap& gap : gaps) {
    starts.push_back(gap.start);
    sum += gap.sum;
  }
  Hypothesis hypothesis = best;
  hypothesis.known = KnownOfValues(context, windows, hypothesis, sum);
  return Fit(hypothesis, windows, starts, held);
}

}  // namespace

Proof ProofOf(const ProofContext& context, const ProofWindows& windows, std::vector<RunData> told,
              std::vector<ProvedSet> sets, const ProofRoles& roles) {
  Proof proof;
  static_cast<ProofRoles&>(proof) = roles;
  proof.sets = std::move(sets);
  for (const RunData* window : windows.near.windows) proof.runs.push_back(window->name);
  const auto owned = std::make_shared<const std::vector<RunData>>(std::move(told));
  std::vector<WindowGap> gaps = GapsOfEach(proof.Found().model, PointersTo(*owned), context.jobs);
  for (size_t w = 0; w < owned->size(); ++w) {
    if (gaps[w].tested) proof.told_runs.push_back(&(*owned)[w]);
  }
  std::erase_if(gaps, [](const WindowGap& gap) { return !gap.tested; });
  proof.windows = owned;
  proof.told.failure = "it cannot be simulated";
  if (!proof.told_runs.empty()) proof.told = WithDerivatives(context, proof.Found(), proof.told_runs, gaps);
  if (proof.told.ok()) {
    proof.seconds = windows.near.seconds;
    proof.sets[proof.best].hypothesis.known = proof.told.hypothesis.known;
  }
  return proof;
}

std::vector<Interval> IntervalsOf(const ProofContext& context, const Proof& proof) {
  constexpr double kUnsaid = std::numeric_limits<double>::quiet_NaN();
  const size_t numbers = proof.Found().Free().size();
  if (numbers == 0) return {};
  if (!proof.told.ok()) return std::vector<Interval>(numbers, {kUnsaid, kUnsaid});
  // The noise of windows is raised to what the model leaves of them, that of whole runs is the sensors'.
  const double gap = proof.OnWindows() ? TypicalGap(proof.Best().near) : proof.told.squared_gap();
  return Intervals(proof.told, proof.told_runs, context.jobs, TemperatureAt(gap));
}

std::vector<Change> MayBeNone(const ProofContext& context, const Proof& proof, double part) {
  const std::vector<Change> effects = proof.Best().Effects();
  if (effects.empty() || !proof.told.ok()) return {};
  std::vector<Change> may_be_none;
  const std::vector<FreeParameter> free = proof.Found().Free();
  const std::vector<Interval> intervals = IntervalsOf(context, proof);
  for (const Change& change : effects) {
    const model::EffectInfo* info = model::FindEffect(change.effect);
    if (info == nullptr || IsClosureEffect(change.effect)) continue;
    size_t amounts = 0, none = 0;
    for (const model::ParameterInfo& parameter : info->parameters) {
      const auto is = [&](const FreeParameter& one) { return one.name == info->id + "." + parameter.name; };
      const auto fitted = std::ranges::find_if(free, is);
      // Of a delay or lag, a time of 0 is none.
      const bool counts = IsAmount(parameter) || parameter.role == model::Role::kTime;
      if (!counts || fitted == free.end()) continue;
      const Interval& interval = intervals[static_cast<size_t>(fitted - free.begin())];
      const double value = fitted->value, low = value - part * (value - interval.low),
                   high = value + part * (interval.high - value);
      ++amounts;
      // An interval that is not known, as that of a number at its bound, excludes nothing.
      if (!(low > 0 || high < 0)) ++none;
    }
    if (amounts > 0 && none == amounts) may_be_none.push_back(change);
  }
  return may_be_none;
}

}  // namespace hydro::diagnose
