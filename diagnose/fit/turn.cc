#include "diagnose/fit/turn.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "diagnose/fit/residuals.h"

namespace hydro::diagnose {

namespace {

constexpr int kAngles = 12;  // tried in each period

// The longest period of the effects that repeat with the shaft, rad; 0 if there are none.
double PeriodOf(const model::ModelDescription& model) {
  double longest = 0;
  for (const model::EffectDescription& effect : model.effects) {
    const model::EffectInfo* info = model::FindEffect(effect);
    if (info == nullptr) continue;
    for (const model::ParameterInfo& parameter : info->parameters) {
      if (parameter.role != model::Role::kPeriods) continue;
      const double periods = effect.parameters.at(parameter.name);
      if (periods > 0) longest = std::max(longest, 2 * std::numbers::pi / periods);
    }
  }
  return longest;
}

}  // namespace

model::StartState AtBestTurn(const model::ModelDescription& model, const RunData& run,
                             const model::StartState& start) {
  const std::optional<size_t> turn = UnknownTurn(model, run);
  const double period = turn.has_value() ? PeriodOf(model) : 0;
  if (!(period > 0)) return start;
  model::StartState best = start;
  double least = SumOfSquares(model, run, start);
  for (int k = 1; k < kAngles; ++k) {
    model::StartState turned = start;
    turned[*turn] += k * period / kAngles;
    const double sum = SumOfSquares(model, run, turned);
    if (sum < least) {
      least = sum;
      best = turned;
    }
  }
  return best;
}

}  // namespace hydro::diagnose
