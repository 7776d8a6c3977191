#include "diagnose/prove/blind_changes.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "base/parallel.h"
#include "diagnose/fit/fit.h"
#include "diagnose/prove/refined_values.h"

namespace hydro::diagnose {
namespace {

// As a fraction of what an effect has to gain: with a smaller gain, refining the other values does not make
// up for the rest.
constexpr double kWorthRefining = 0.5;
// From the catalogue's starts, which differ by factors of 2 to 6. Whoever asks for an effect by name knows
// that the machine may have it, so its fit may find a longer way.
constexpr int kStepsOfARace = 2, kStepsOfARequest = 8;

}  // namespace

std::vector<Change> BlindChanges(const ProofContext& context) {
  const bool free = std::ranges::any_of(
      context.runs, [](const RunData* run) { return run->stimulus.shaft == model::Shaft::kFree; });
  // Where no pressure was measured, no effect of the oil shows.
  const bool oil = std::ranges::any_of(context.runs, [](const RunData* run) {
    return !run->stimulus.bypass && run->measured.p1.measured() && run->measured.p2.measured();
  });
  const bool angle = std::ranges::any_of(
      context.runs, [](const RunData* run) { return run->measured.motor_angle.measured(); });
  std::vector<Change> blind;
  for (const Change& change : context.changes) {
    // In every hypothesis balances allow for signals that are late by a little; simulations do not. A speed
    // that a drive computes is filtered; beside its angle it has been moved already.
    const auto signal = change.names.find("signal");
    const bool late_speed =
        change.effect == "sensor.skew" && signal != change.names.end() && signal->second == "motor_speed";
    if (late_speed && !angle) blind.push_back(change);
    // A sensor's sign has already been settled.
    const bool is_blind = IsUnseenByBalances(change.effect) && change.names.empty();
    const bool shows = oil || !model::FindEffect(change.effect)->needs_oil;
    if (is_blind && shows && (free || !change.effect.starts_with("arm."))) blind.push_back(change);
  }
  return blind;
}

ProvedSet RacedFrom(const ProofContext& context, const std::vector<const RunData*>& fitted,
                    const ProofWindows& windows, const ProvedSet& set, const Change& change) {
  const std::vector<Hypothesis> starts = With(set.hypothesis, change, context.sizes, MovableValues(context));
  const std::vector<model::StartState> from = CorrectedStarts(set.hypothesis.model, fitted, context.jobs);
  FitOptions options;
  const bool asked = model::FindEffect(change.effect)->on_request;
  options.most_iterations = asked ? kStepsOfARequest : kStepsOfARace;
  options.tolerance = kToCompare;
  options.at_turn = true;
  std::vector<Fitted> fits(starts.size());
  ParallelFor(starts.size(), context.jobs, [&](size_t i) {
    Hypothesis alone = starts[i];
    std::erase_if(alone.base, [&](size_t place) {  // but not what the start itself frees
      return std::ranges::find(set.hypothesis.base, place) != set.hypothesis.base.end();
    });
    alone.known = nullptr;
    alone.effects = {change.effect};
    fits[i] = Fit(alone, fitted, from, options);
  });
  std::optional<size_t> best;
  for (size_t i = 0; i < fits.size(); ++i) {
    if (fits[i].ok() && (!best || fits[i].sum < fits[*best].sum)) best = i;
  }
  ProvedSet raced;
  raced.hypothesis = starts[best.value_or(0)];
  raced.hypothesis.measured = nullptr;  // without the change
  if (!best) return raced;
  raced.hypothesis.model = fits[*best].hypothesis.model;
  JudgeSet(windows, context.jobs, &raced);
  const GapFall fall = FallOf(set.near, raced.near);
  if (fall.logarithm >= kWorthRefining * -std::log1p(-kPartOfAnEffect))
    RefineValues(context, fitted, windows, kComparedValues, &raced);
  return raced;
}

bool IsUnseenByBalances(const std::string& effect) {
  const model::EffectInfo* info = model::FindEffect(effect);
  return info != nullptr && info->unseen_by_balances;
}

}  // namespace hydro::diagnose
