#include "diagnose/fit/turn.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "diagnose/fit/residuals.h"

namespace hydro::diagnose {

namespace {

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
  double least = std::numeric_limits<double>::infinity();
  const auto sum_at = [&](double part) {
    model::StartState turned = start;
    turned[*turn] += part * period;
    const double sum = SumOfSquares(model, run, turned);
    if (sum < least) {
      least = sum;
      best = turned;
    }
    return sum;
  };
  // What repeats adds a wave to the prediction, so that the sum follows one wave over the turn, which its
  // quarters show.
  std::array<double, 4> sums;
  for (size_t k = 0; k < sums.size(); ++k) sums[k] = sum_at(0.25 * static_cast<double>(k));
  const double cosine = sums[0] - sums[2], sine = sums[1] - sums[3];
  if (std::isfinite(cosine) && std::isfinite(sine))
    sum_at(std::atan2(-sine, -cosine) / (2 * std::numbers::pi));
  return best;
}

}  // namespace hydro::diagnose
