#include "model/response.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "model/integrate/response_machine.h"
#include "model/terms/parameter_info.h"

namespace hydro::model {

namespace {

template <class T>
NumbersOf<T> NumbersAs(const NumbersOf<double>& numbers) {
  NumbersOf<T> result;
  NumbersOf<double> from = numbers;
  for (size_t i = 0; i < BaseParameters().size(); ++i) {
    BaseValue(result.parameters, i) = T(BaseValue(from.parameters, i));
  }
  for (const double value : numbers.own) result.own.emplace_back(value);
  return result;
}

// Simulates once with unknowns [first, first + kJetWidth) as directions; none when T is double.
template <class T>
void Pass(const ModelDescription& model, const Stimulus& stimulus, const StartState& start,
          const std::vector<Unknown>& unknowns, size_t first, const ResponseOptions& options,
          Response* response) {
  ActuatorOptions actuator;
  actuator.shaft = stimulus.shaft;
  actuator.bypass = stimulus.bypass;
  actuator.repeated_effects = options.repeated_effects;
  actuator.motion = stimulus.motion;
  actuator.arm_angle = stimulus.shaft == Shaft::kFree ? start[kArmAngle] : stimulus.arm_angle;
  Equations equations(model, actuator);
  NumbersOf<T> numbers = NumbersAs<T>(equations.data());
  T state[6];
  for (size_t i = 0; i < 6; ++i) state[i] = T(start[i]);
  const size_t last = std::min(unknowns.size(), first + static_cast<size_t>(kJetWidth));
  if constexpr (!std::is_same_v<T, double>) {
    for (size_t u = first; u < last; ++u) {
      const Unknown& unknown = unknowns[u];
      Jet& seeded = unknown.kind == Unknown::Kind::kBase     ? BaseValue(numbers.parameters, unknown.index)
                    : unknown.kind == Unknown::Kind::kEffect ? numbers.own.at(unknown.index)
                                                             : state[unknown.index];
      seeded.v[u - first] = 1;
    }
  }
  if (stimulus.bypass) state[kP2] = state[kP1];
  CompleteNumbers<T>(equations.data(), &numbers);

  ResponseMachine<T> machine(&equations, numbers, options.relative_tolerance);
  machine.Start(stimulus.time.front(), state);
  const double duration = stimulus.time.back() - stimulus.time.front();
  // The steps of a fourth-order method are as the fourth root of its error.
  const double finer = std::max(1.0, std::pow(1e-6 / options.relative_tolerance, 0.25));
  machine.AllowSteps(
      static_cast<int64_t>(finer * (20 * static_cast<double>(stimulus.time.size()) + 500 * duration)) + 1000);
  const bool values = first == 0;
  size_t row = 0;
  for (size_t k = 0; k < stimulus.time.size(); ++k) {
    if (k > 0) machine.Advance(stimulus.voltage[k - 1], stimulus.time[k]);
    if (k % options.stride != 0) continue;
    const MeasurementOf<T> measured = machine.Measure();
    for (size_t c = 0; c < kChannels; ++c) {
      if (!options.channels[c]) continue;
      const T& value = ChannelOf(measured, c);
      if (values) response->values[c][row] = ValueOf(value);
      if constexpr (!std::is_same_v<T, double>) {
        for (size_t u = first; u < last; ++u) {
          response->derivatives[u][c][row] = value.v[u - first];
        }
      }
    }
    ++row;
  }
}

}  // namespace

std::vector<EffectParameter> EffectParameters(const ModelDescription& model) {
  std::vector<size_t> order(model.effects.size());
  for (size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(),
                   [&](size_t a, size_t b) { return model.effects[a].id < model.effects[b].id; });
  std::vector<EffectParameter> parameters;
  for (const size_t i : order) {
    const EffectInfo* info = FindEffect(model.effects[i].id);
    if (info == nullptr) throw ModelError("effect \"" + model.effects[i].id + "\" is not known");
    for (const ParameterInfo& parameter : info->parameters) {
      if (!parameter.is_name) parameters.push_back({i, parameter.name});
    }
  }
  return parameters;
}

Response Respond(const ModelDescription& model, const Stimulus& stimulus, const StartState& start,
                 const std::vector<Unknown>& unknowns, const ResponseOptions& options) {
  const size_t rows = (stimulus.time.size() + options.stride - 1) / options.stride;
  Response response;
  response.derivatives.resize(unknowns.size());
  for (size_t c = 0; c < kChannels; ++c) {
    if (!options.channels[c]) continue;
    response.values[c].resize(rows);
    for (auto& derivative : response.derivatives) derivative[c].resize(rows);
  }
  if (unknowns.empty()) {
    Pass<double>(model, stimulus, start, unknowns, 0, options, &response);
  } else {
    for (size_t first = 0; first < unknowns.size(); first += kJetWidth) {
      Pass<Jet>(model, stimulus, start, unknowns, first, options, &response);
    }
  }
  return response;
}

}  // namespace hydro::model
