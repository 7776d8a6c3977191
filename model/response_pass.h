// One simulation of a response, with derivatives in up to kJetWidth directions. A template, for response.cc
// and response_wide.cc only.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "model/equations/read_sensors.h"
#include "model/integrate/derivative_stepper.h"
#include "model/integrate/mode_machine.h"
#include "model/response.h"
#include "model/start_from.h"
#include "model/terms/parameter_info.h"

namespace hydro::model {

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

// The mean of both ends, held for a sample, gives the arm the same impulse as the straight line between them.
inline Surroundings OverASample(const Surroundings& from, const Surroundings& to) {
  return {0.5 * (from.arm_force + to.arm_force), 0.5 * (from.temperature + to.temperature)};
}

// Steps that a pass may take for each second, however coarse its samples: a hydraulic actuator's own modes
// lie below some 500 Hz, and one that rings freely takes some 40 steps a period.
inline constexpr double kStepsPerSecond = 20000;

// The largest number of steps in a pass, so that a far too stiff model does not take hours.
inline int64_t MostSteps(const Stimulus& stimulus, const ResponseOptions& options) {
  const double duration = stimulus.time.back() - stimulus.time.front();
  // The step of a fourth-order method scales with the fourth root of the error.
  const double finer = std::max(1.0, std::pow(1e-6 / options.relative_tolerance, 0.25));
  const double samples = static_cast<double>(stimulus.time.size());
  return static_cast<int64_t>(finer *
                              (options.most_steps_per_sample * samples + kStepsPerSecond * duration)) +
         1000;
}

// Seeds the unknowns [first, first + kJetWidth) as directions, in `numbers` and `base`.
inline void Seed(const std::vector<Unknown>& unknowns, size_t first, NumbersOf<Jet>* numbers, Jet* base) {
  const size_t last = std::min(unknowns.size(), first + static_cast<size_t>(kJetWidth));
  for (size_t u = first; u < last; ++u) {
    const Unknown& unknown = unknowns[u];
    Jet& seeded = unknown.kind == Unknown::Kind::kBase     ? BaseValue(numbers->parameters, unknown.index)
                  : unknown.kind == Unknown::Kind::kEffect ? numbers->own.at(unknown.index)
                                                           : base[unknown.index];
    seeded.SetDerivative(static_cast<int>(u - first), 1);
  }
}

// Simulates once with unknowns [first, first + kJetWidth) as directions; with none when T is double.
template <class T>
void Pass(const ModelDescription& model, const Stimulus& stimulus, const StartState& start,
          const std::vector<Unknown>& unknowns, size_t first, const ResponseOptions& options,
          Response* response) {
  ActuatorOptions actuator;
  actuator.shaft = stimulus.shaft;
  actuator.bypass = stimulus.bypass;
  actuator.begin = stimulus.begin;
  actuator.motion = stimulus.motion;
  actuator.arm_angle = stimulus.shaft == Shaft::kFree ? start[kArmAngle] : stimulus.arm_angle;
  Equations equations(model, actuator);
  if (!stimulus.around.empty()) equations.Surround(stimulus.around.front());
  NumbersOf<T> numbers = NumbersAs<T>(equations.data());
  constexpr size_t kNumbers = std::tuple_size_v<StartState>;
  T base[kNumbers];
  for (size_t i = 0; i < kNumbers; ++i) base[i] = T(start[i]);
  if constexpr (!std::is_same_v<T, double>) Seed(unknowns, first, &numbers, base);
  if (stimulus.bypass) base[kP2] = base[kP1];
  CompleteNumbers<T>(equations.data(), &numbers);

  ModeMachine<T, Form::kGeneral, DerivativeStepper<T>> machine(
      &equations, &numbers, &numbers, options.relative_tolerance, MostSteps(stimulus, options));
  T state[kMaxStates];
  const Mode mode = StartFrom(&equations, numbers, stimulus.time.front(), base, state);
  machine.Start(stimulus.time.front(), state, mode);
  const size_t last = std::min(unknowns.size(), first + static_cast<size_t>(kJetWidth));
  const bool values = first == 0;
  size_t row = 0;
  for (size_t k = 0; k < stimulus.time.size(); ++k) {
    if (k > 0 && !stimulus.around.empty())
      machine.Surround(OverASample(stimulus.around[k - 1], stimulus.around[k]));
    if (k > 0) machine.Advance(stimulus.voltage[k - 1], stimulus.time[k]);
    if (k % options.stride != 0) continue;
    MeasurementOf<T> measured =
        ReadSensors<T>(equations.data(), numbers, machine.now().time, machine.now().state, machine.history());
    measured.motor_angle -= base[kTurn];
    for (size_t c = 0; c < kChannels; ++c) {
      if (!options.channels[c]) continue;
      const T& value = ChannelOf(measured, c);
      if (values) response->values[c][row] = ValueOf(value);
      if constexpr (!std::is_same_v<T, double>) {
        for (size_t u = first; u < last; ++u) {
          response->derivatives[u][c][row] = value.v[static_cast<int>(u - first)];
        }
      }
    }
    ++row;
  }
}

// Pass<Jet> in the processor's widest vectors: the same bits in half the time. Only where HYDRO_WIDE_VECTORS
// is defined, and only for processors with AVX-512.
void WidePass(const ModelDescription& model, const Stimulus& stimulus, const StartState& start,
              const std::vector<Unknown>& unknowns, size_t first, const ResponseOptions& options,
              Response* response);

}  // namespace hydro::model
