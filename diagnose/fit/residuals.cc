#include "diagnose/fit/residuals.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "model/terms/parameter_info.h"
#include "model/terms/state.h"

namespace hydro::diagnose {
namespace {

// Relative tolerance of an integration step. With 1e-5, a Stribeck speed of 0.1 rad/s came out 11 % too
// large, outside its interval. 1e-6 takes a tenth less of a diagnosis, but moves values that the runs hardly
// show.
constexpr double kTolerance = 1e-7;

}  // namespace

Residuals ResidualsOf(const model::ModelDescription& model, const RunData& run,
                      const model::StartState& start, const std::vector<FreeParameter>& free,
                      const std::vector<model::Unknown>& starts) {
  std::vector<model::Unknown> unknowns;
  unknowns.reserve(free.size() + starts.size());
  for (const FreeParameter& parameter : free) unknowns.push_back(parameter.unknown);
  unknowns.insert(unknowns.end(), starts.begin(), starts.end());
  model::ResponseOptions options;
  options.channels = {};
  options.relative_tolerance = kTolerance;
  options.most_steps_per_sample = run.most_steps_per_sample;
  for (const SignalData& signal : run.signals) options.channels[static_cast<size_t>(signal.channel)] = true;
  const model::Response response = model::Respond(model, run.stimulus, start, unknowns, options);

  Residuals residuals;
  for (const SignalData& signal : run.signals) {
    residuals.first.push_back(residuals.values.size());
    const std::vector<double>& predicted = response.values[static_cast<size_t>(signal.channel)];
    for (size_t row = 0; row < predicted.size(); ++row) {
      const double measured = signal.values[row];
      if (!std::isnan(measured)) residuals.values.push_back((predicted[row] - measured) / signal.noise);
    }
  }
  residuals.first.push_back(residuals.values.size());
  residuals.jacobian.resize(unknowns.size() * residuals.values.size());
  size_t next = 0;
  for (size_t u = 0; u < unknowns.size(); ++u) {
    for (const SignalData& signal : run.signals) {
      const std::vector<double>& derivative = response.derivatives[u][static_cast<size_t>(signal.channel)];
      for (size_t row = 0; row < derivative.size(); ++row) {
        if (!std::isnan(signal.values[row])) residuals.jacobian[next++] = derivative[row] / signal.noise;
      }
    }
  }
  for (size_t i = 0; i < free.size(); ++i) {
    if (!free[i].logarithmic) continue;
    const size_t rows = residuals.values.size();
    for (size_t row = i * rows; row < (i + 1) * rows; ++row) residuals.jacobian[row] *= free[i].Slope();
  }
  return residuals;
}

double SumOfSquares(const model::ModelDescription& model, const RunData& run,
                    const model::StartState& start) {
  double sum = 0;
  try {
    for (const double value : ResidualsOf(model, run, start).values) sum += value * value;
  } catch (const model::ModelError&) {
    return std::numeric_limits<double>::infinity();
  }
  return std::isnan(sum) ? std::numeric_limits<double>::infinity() : sum;
}

std::optional<size_t> UnknownTurn(const model::ModelDescription& model, const RunData& run) {
  bool repeats = false, all_have_phases = true;
  for (const model::EffectDescription& effect : model.effects) {
    if (!model::HasRole(effect.id, model::Role::kPeriods)) continue;
    repeats = true;
    all_have_phases = all_have_phases && model::HasRole(effect.id, model::Role::kPhase);
  }
  if (!repeats || (all_have_phases && run.angle_counts)) return std::nullopt;
  return run.Find(model::Channel::kMotorAngle) != nullptr ? model::kTurn
                                                          : static_cast<size_t>(model::kMotorAngle);
}

std::vector<model::Unknown> StartUnknowns(const model::ModelDescription& model, const RunData& run) {
  const std::optional<size_t> turn = UnknownTurn(model, run);
  const bool waves = run.begins_within && std::ranges::any_of(model.effects, [](const auto& effect) {
                       return model::HasRole(effect.id, model::Role::kFrequency);
                     });
  const bool returned = std::ranges::any_of(model.effects, [](const auto& effect) {
    const model::EffectInfo* info = model::FindEffect(effect);
    return info != nullptr && info->remembers_flow;
  });
  std::vector<model::Unknown> unknowns;
  for (size_t i = 0; i < run.start_free.size(); ++i) {
    const bool wave = i >= model::kWaves && i < model::kWaves + model::kWaveNumbers;
    if (run.start_free[i] || turn == i || (waves && wave) || (returned && i == model::kReturned)) {
      unknowns.push_back({model::Unknown::Kind::kStart, i});
    }
  }
  return unknowns;
}

}  // namespace hydro::diagnose
