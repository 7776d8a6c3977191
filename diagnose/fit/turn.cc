#include "diagnose/fit/turn.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include "diagnose/fit/residuals.h"

namespace hydro::diagnose {
namespace {

// Appends the effect's numbers that have this role.
void AddNumbers(const model::EffectDescription& effect, model::Role role, std::vector<double>* numbers) {
  const model::EffectInfo* info = model::FindEffect(effect);
  if (info == nullptr) return;
  for (const model::ParameterInfo& parameter : info->parameters) {
    if (parameter.role == role) numbers->push_back(effect.parameters.at(parameter.name));
  }
}

// The longest period of the effects that repeat with the shaft, rad; 0 if there are none.
double PeriodOf(const model::ModelDescription& model) {
  std::vector<double> all;
  for (const model::EffectDescription& effect : model.effects)
    AddNumbers(effect, model::Role::kPeriods, &all);
  double longest = 0;
  for (const double periods : all) {
    if (periods > 0) longest = std::max(longest, 2 * std::numbers::pi / periods);
  }
  return longest;
}

// rad: the correction of the start follows a phase that differs by less from the one that was searched.
constexpr double kSamePhase = 0.5;

bool AreNear(const std::vector<double>& a, const std::vector<double>& b, double apart) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [apart](double one, double other) { return std::abs(one - other) <= apart; });
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

model::StartState KnownTurns::Turned(size_t place, const model::ModelDescription& model,
                                     const RunData& window, const model::StartState& start) {
  const std::optional<size_t> turn = UnknownTurn(model, window);
  if (!turn.has_value()) return start;
  Known now{};
  for (const model::EffectDescription& effect : model.effects) {
    if (!model::HasRole(effect.id, model::Role::kPeriods)) continue;
    now.effects.push_back(effect.id);
    AddNumbers(effect, model::Role::kPeriods, &now.periods);
    AddNumbers(effect, model::Role::kPhase, &now.phases);
  }
  model::StartState turned = start;
  for (const Known& known : known_[place]) {
    if (known.effects != now.effects || !AreNear(known.periods, now.periods, 0)) continue;
    if (!AreNear(known.phases, now.phases, kSamePhase)) continue;
    turned[*turn] = known.turn;
    return turned;
  }
  turned = AtBestTurn(model, window, start);
  now.turn = turned[*turn];
  known_[place].push_back(std::move(now));
  return turned;
}

}  // namespace hydro::diagnose
