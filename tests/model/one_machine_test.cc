// The simulated plant and the fitted model run through one mode machine: they agree through every kind of
// switch, whatever the steps between.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "model/response.h"
#include "model/trajectory/trajectory.h"
#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

struct Machine {
  std::string name;
  model::ModelDescription model;
  model::Shaft shaft = model::Shaft::kClamped;
  bool bypass = false;
  int switches = 0;  // of valves and effects: as many change in the run, besides the pump's
};

const trajectory::Trajectory& Motion() {
  static const auto motion = trajectory::MakeSine(0.1, 0.2, 3, 0.01, 0);
  return *motion;
}

std::vector<Machine> Machines() {
  const model::EffectDescription check = {"valve.check", {{"cracking", 5}, {"conductance", 0.01}}, {}};
  const model::EffectDescription relief = {"valve.relief", {{"set", 250}, {"conductance", 1e-3}}, {}};
  const model::EffectDescription seal = {"actuator.seal_friction", {{"coulomb", 300}, {"viscous", 50}}, {}};
  const model::EffectDescription wave = Wave(300, 0.2, 0.05);
  const model::EffectDescription flexure = {"arm.flexure", {{"stiffness", 2e5}, {"damping", 500}}, {}};
  const model::EffectDescription delay = {"amp.delay", {{"delay", 3.33e-4}}, {}};
  const model::EffectDescription skew = {"sensor.skew", {{"delay", 3.33e-4}}, {{"signal", "p2"}}};
  const auto clamped = model::Shaft::kClamped;
  const auto free = model::Shaft::kFree;
  return {
      {.name = "Clamped", .model = Table1Model(), .switches = 1},
      {.name = "Free", .model = Table1Model(), .shaft = free, .switches = 2},
      {.name = "Driven", .model = Table1Model(), .shaft = model::Shaft::kDriven, .switches = 2},
      {.name = "Bypass", .model = Table1Model(), .shaft = clamped, .bypass = true, .switches = 0},
      {.name = "Stribeck", .model = Table1Model({Stribeck(0.5, 3)}), .switches = 1},
      {.name = "StribeckFree", .model = Table1Model({Stribeck(0.5, 3)}), .shaft = free, .switches = 2},
      {.name = "Wave", .model = Table1Model({wave}), .switches = 1},
      {.name = "Check", .model = Table1Model({check}), .switches = 1},
      {.name = "Relief", .model = Table1Model({relief}), .switches = 4},
      {.name = "SealFriction", .model = Table1Model({seal}), .shaft = free, .switches = 2},
      {.name = "DelayAndSkew", .model = Table1Model({delay, skew}), .shaft = free, .switches = 2},
      {.name = "All",
       .model = Table1Model({Stribeck(0.5, 3), wave, check, relief, seal, flexure, delay, skew}),
       .shaft = free,
       .switches = 2},
  };
}

class OneMachine : public ::testing::TestWithParam<Machine> {};

// Levels that stick, slip, turn round and saturate, sampled at 1 kHz.
model::Stimulus Levels(const Machine& c) {
  model::Stimulus stimulus;
  stimulus.shaft = c.shaft;
  stimulus.bypass = c.bypass;
  stimulus.arm_angle = 0.1;
  stimulus.motion = c.shaft == model::Shaft::kDriven ? &Motion() : nullptr;
  constexpr double kLevels[] = {0.5, 6, 1.2, -4, 0, 3, 11, -11, 2, -1.5};
  for (size_t k = 0; k < 800; ++k) {
    stimulus.time.push_back(1e-3 * static_cast<double>(k));
    stimulus.voltage.push_back(kLevels[k / 61 % 10]);
  }
  return stimulus;
}

// Tests that the plant's simulation and Respond read the same at every sample of a run in which the pump
// sticks and slips both ways and the switches of valves and effects change.
TEST_P(OneMachine, PlantAndFitAgree) {
  const Machine& c = GetParam();
  const model::Stimulus stimulus = Levels(c);
  constexpr double kTolerance = 1e-10;
  model::ActuatorOptions options = Held(c.shaft, model::Integrator::kAuto);
  options.bypass = c.bypass;
  options.motion = stimulus.motion;
  options.arm_angle = stimulus.arm_angle;
  options.relative_tolerance = kTolerance;
  Rig rig(c.model, options);

  model::ResponseOptions exact;
  exact.relative_tolerance = kTolerance;
  const double p_3 = c.model.parameters.p_3;
  const model::Response fitted =
      model::Respond(c.model, stimulus, {0, 0, p_3, p_3, stimulus.arm_angle, 0}, {}, exact);

  std::array<std::vector<double>, model::kChannels> plant;
  std::set<int> pump;
  std::array<std::set<int>, 2 + model::kMaxEffectSwitches> others;
  for (size_t k = 0; k < stimulus.time.size(); ++k) {
    // Modes that last for less than a sample are seen too.
    for (int part = 1; part <= 20 && k > 0; ++part) {
      const double from = stimulus.time[k - 1];
      const double to = part == 20 ? stimulus.time[k] : from + part / 20.0 * (stimulus.time[k] - from);
      rig.simulation->Advance(stimulus.voltage[k - 1], to);
      const model::Mode& mode = rig.simulation->mode();
      pump.insert(mode.pump);
      others[0].insert(mode.valve_1);
      others[1].insert(mode.valve_2);
      for (size_t i = 2; i < others.size(); ++i) others[i].insert(mode.effects[i - 2]);
    }
    const model::Measurement read = rig.Measure();
    for (size_t i = 0; i < model::kChannels; ++i) plant[i].push_back(model::ChannelOf(read, i));
  }

  EXPECT_EQ(pump, (std::set<int>{-1, 0, 1}));
  EXPECT_EQ(std::count_if(others.begin(), others.end(), [](const auto& seen) { return seen.size() > 1; }),
            c.switches);
  for (size_t i = 0; i < model::kChannels; ++i) {
    double size = 0;
    for (const double value : plant[i]) size = std::max(size, std::abs(value));
    double worst = 0;
    for (size_t k = 0; k < plant[i].size(); ++k) {
      worst = std::max(worst, std::abs(plant[i][k] - fitted.values[i][k]));
    }
    EXPECT_LE(worst, 3e-7 * size) << "channel " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Model, OneMachine, ::testing::ValuesIn(Machines()),
                         [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace hydro::testing
