// Derivatives by the effects' parameters: against difference quotients, and finite where an effect vanishes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "model/equations/evaluate.h"
#include "model/equations/read_sensors.h"
#include "model/terms/parameter_info.h"
#include "tests/model/model_case.h"
#include "tests/model/some_of_each.h"

namespace hydro::testing {
namespace {

// States' rates, switches' margins and readings, with derivatives by the model's first effects' parameters.
std::vector<model::Jet> Evaluated(const model::Equations& equations, const model::Mode& mode,
                                  const std::vector<double>& state) {
  const model::EquationData& data = equations.data();
  model::NumbersOf<model::Jet> numbers = *data.constants;
  for (size_t k = 0; k < numbers.own.size(); ++k) numbers.own[k].SetDerivative(static_cast<int>(k), 1);
  model::CompleteNumbers<model::Jet>(data, &numbers);
  model::Jet y[model::kMaxStates], rate[model::kMaxStates], margin[model::kMaxSwitches];
  for (int i = 0; i < data.states; ++i) y[i] = model::Jet(state[i]);
  model::Terms<model::Jet> x;
  x.voltage_acts = true;
  model::EvaluateTerms<model::Form::kGeneral, model::Jet>(data, numbers, 0.03, model::Jet(5.0), mode, y, rate,
                                                          x);
  model::FindMargins<model::Form::kGeneral, model::Jet>(data, numbers, mode, x, margin);
  model::StateHistory<model::Jet> history(data.states, 1);
  history.Add(0.0, y, rate);
  model::Jet later[model::kMaxStates];
  for (int i = 0; i < data.states; ++i) later[i] = y[i] + 0.03 * rate[i];
  history.Add(0.03, later, rate);
  const model::MeasurementOf<model::Jet> m =
      model::ReadSensors<model::Jet>(data, numbers, 0.03, later, &history);
  std::vector<model::Jet> all(rate, rate + data.states);
  all.insert(all.end(), margin, margin + data.switches);
  all.insert(all.end(), {m.motor_angle, m.motor_speed, m.arm_angle, m.arm_speed, m.p1, m.p2});
  return all;
}

std::vector<double> Somewhere(const model::Equations& equations, int pump) {
  std::vector<double> state(equations.states());
  model::Mode at_rest;
  equations.Start(300, state.data(), &at_rest);
  for (int i = 0; i < equations.states(); ++i) state[i] += equations.scales()[i] * (1 + 0.3 * i);
  state[model::kMotorSpeed] = pump * 2.5;
  return state;
}

// Tests each parameter of each effect in modes with its switches at every position.
TEST(EffectDerivatives, EqualDifferenceQuotients) {
  for (const model::EffectInfo& info : model::EffectCatalogue()) {
    if (DelaysCommands(info)) continue;  // its stops have the derivative
    for (int position = -2; position <= 2; ++position) {
      for (const int pump : {-1, 0, 1}) {
        model::Mode mode;
        mode.pump = static_cast<int8_t>(pump);
        mode.valve_1 = position > 0;
        mode.effects.fill(static_cast<int8_t>(position));
        const model::EffectDescription& effect = SomeOfEach().at(info.id);
        const model::Equations equations(Table1Model({effect}), Held(model::Shaft::kFree));
        const std::vector<double> state = Somewhere(equations, pump);
        const std::vector<model::Jet> found = Evaluated(equations, mode, state);
        int k = -1;
        for (const model::ParameterInfo& parameter : info.parameters) {
          if (parameter.is_name()) continue;
          ++k;
          const double value = effect.parameters.at(parameter.name);
          const auto at = [&](double factor) {
            model::EffectDescription moved = effect;
            moved.parameters[parameter.name] = value * factor;
            return Evaluated(model::Equations(Table1Model({moved}), Held(model::Shaft::kFree)), mode, state);
          };
          const std::vector<model::Jet> up = at(1 + 1e-4), down = at(1 - 1e-4);
          for (size_t i = 0; i < found.size(); ++i) {
            EXPECT_NEAR(found[i].v[k] * value, (up[i].a - down[i].a) / 2e-4,
                        1e-6 * (std::abs(found[i].a) + std::abs(found[i].v[k] * value)) + 1e-9)
                << info.id << "." << parameter.name << ", number " << i << ", position " << position;
          }
        }
      }
    }
  }
}

// Tests that each effect has a parameter that matters.
TEST(EffectDerivatives, AreNotAllZero) {
  for (const model::EffectInfo& info : model::EffectCatalogue()) {
    const bool has_number =
        std::any_of(info.parameters.begin(), info.parameters.end(),
                    [](const model::ParameterInfo& parameter) { return parameter.is_number(); });
    if (DelaysCommands(info) || !has_number) continue;
    model::Mode mode;
    mode.pump = 1;
    mode.effects.fill(1);
    const model::Equations equations(Table1Model({SomeOfEach().at(info.id)}), Held(model::Shaft::kFree));
    double sum = 0;
    for (const model::Jet& number : Evaluated(equations, mode, Somewhere(equations, 1))) {
      for (int k = 0; k < model::kJetWidth; ++k) sum += std::abs(number.v[k]);
    }
    EXPECT_GT(sum, 0) << info.id;
  }
}

// Tests that a fit can start where an effect vanishes: with every parameter that may be 0 at 0, and equal
// pressures, all is finite.
TEST(EffectDerivatives, AreFiniteWhereTheEffectVanishes) {
  for (const model::EffectInfo& info : model::EffectCatalogue()) {
    if (DelaysCommands(info)) continue;
    model::EffectDescription effect = SomeOfEach().at(info.id);
    for (const model::ParameterInfo& parameter : info.parameters) {
      const bool may_vanish =
          !parameter.is_name() && (parameter.min < 0 || (parameter.min == 0 && parameter.min_allowed));
      if (may_vanish) effect.parameters[parameter.name] = 0;
    }
    for (int position = -1; position <= 1; ++position) {
      model::Mode mode;
      mode.pump = static_cast<int8_t>(position);
      mode.effects.fill(static_cast<int8_t>(position));
      const model::Equations equations(Table1Model({effect}), Held(model::Shaft::kFree));
      std::vector<double> state(equations.states());
      model::Mode at_rest;
      equations.Start(100, state.data(), &at_rest);
      for (const model::Jet& number : Evaluated(equations, mode, state)) {
        EXPECT_TRUE(std::isfinite(number.a)) << info.id;
        for (int k = 0; k < model::kJetWidth; ++k) EXPECT_TRUE(std::isfinite(number.v[k])) << info.id;
      }
    }
  }
}

}  // namespace
}  // namespace hydro::testing
