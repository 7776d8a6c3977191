// The same rig in other units moves in the same way: no term of the model depends on what its numbers are in.
#include <gmock/gmock.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/random.h"
#include "model/effects/catalogue.h"
#include "tests/model/some_of_each.h"
#include "tests/model_in_units.h"

namespace hydro::testing {
namespace {

struct Signal {
  double model::Measurement::*value;
  const char* unit;
  int arm;
};
constexpr Signal kSignals[] = {
    {&model::Measurement::motor_angle, "rad", 0}, {&model::Measurement::motor_speed, "rad/s", 0},
    {&model::Measurement::arm_angle, "rad", 1},   {&model::Measurement::arm_speed, "rad/s", 1},
    {&model::Measurement::p1, "psi", 0},          {&model::Measurement::p2, "psi", 0}};

struct Start {
  model::Shaft shaft = model::Shaft::kFree;
  double arm = 0;  // in the first system, like what follows
  double pressure = std::nan("");
};

// Steps of both signs, some beyond the amplifier's limit, with rests at 0 in which the pump sticks.
double StepsAndRests(int tick) {
  constexpr std::array kSteps = {0.0, 3.0, -5.0, 12.0, 0.0, -1.5, 7.0, 0.0};
  return kSteps[static_cast<size_t>(tick / 40) % kSteps.size()] + 0.5 * std::sin(0.1 * tick);
}

std::vector<model::Measurement> Motion(const model::ModelDescription& first, const UnitSystem& to,
                                       const Start& start, int ticks) {
  const model::ModelDescription model = InUnits(first, to);
  // Where CVODE has to step in, a change in the last bit of a value shows at the default tolerance of 1e-8.
  model::ActuatorOptions options = {.shaft = start.shaft,
                                    .arm_angle = start.arm * Factor("rad", 1, first.units, to),
                                    .relative_tolerance = 1e-10};
  if (!std::isnan(start.pressure))
    options.initial_pressure = start.pressure * Factor("psi", 0, first.units, to);
  model::Actuator actuator(model, options);
  std::vector<model::Measurement> motion;
  for (int k = 0; k < ticks; ++k) {
    motion.push_back(actuator.Measure());
    actuator.Advance(StepsAndRests(k), (k + 1) * 1e-3);
  }
  return motion;
}

// The largest difference of any signal from the first system's, over the signal's own size.
double Difference(const model::ModelDescription& model, const Start& start, int ticks = 400) {
  const std::vector<model::Measurement> first = Motion(model, model.units, start, ticks);
  double worst = 0;
  for (const UnitSystem& system : kSystems) {
    const UnitSystem to = WithArm(system, model.units.linear_arm);
    const std::vector<model::Measurement> other = Motion(model, to, start, ticks);
    for (const Signal& signal : kSignals) {
      const double factor = Factor(signal.unit, signal.arm, to, model.units);
      double size = 0, difference = 0;
      for (size_t k = 0; k < first.size(); ++k) {
        size = std::max(size, std::abs(first[k].*signal.value));
        difference =
            std::max(difference, std::abs(factor * (other[k].*signal.value) - first[k].*signal.value));
      }
      if (size > 0) worst = std::max(worst, difference / size);
    }
  }
  return worst;
}

// A rig like the paper's. A linear one is its actuator unrolled: c is an area, in in^2.
model::ModelDescription DrawnRig(Random& random, bool linear) {
  model::ModelDescription model = Table1Model();
  model.units.linear_arm = linear;
  for (const model::BaseParameter& parameter : model::BaseParameters()) {
    model.parameters.*parameter.member *= std::exp(0.3 * (2 * random.Unit() - 1));
  }
  model.parameters.f = 1e-4 * random.Unit();
  model.parameters.mgl = 600 * (2 * random.Unit() - 1);
  for (const auto& some : SomeOfEach()) {
    const model::EffectDescription& effect = some.second;
    if (random.Unit() >= 0.1) continue;
    const bool excluded = std::any_of(
        model.effects.begin(), model.effects.end(),
        [&](const model::EffectDescription& own) { return model::ExcludeEachOther(own, effect); });
    model.effects.push_back(effect);
    try {
      const model::Equations accepted(model, {});
      EXPECT_FALSE(excluded) << effect.id;
    } catch (const model::ModelError& error) {
      // A rig has one accumulator and one kind of one-way valves.
      EXPECT_TRUE(excluded) << effect.id;
      EXPECT_THAT(error.what(), ::testing::HasSubstr("second of its kind"));
      model.effects.pop_back();
    }
  }
  return model;
}

// Tests that Table 1 with each effect of the catalogue moves in the same way in all systems of units, with an
// arm that turns and with one that moves along a line.
TEST(Units, EveryEffectIsTheSameInAll) {
  for (const bool linear : {false, true}) {
    for (const auto& [id, effect] : SomeOfEach()) {
      model::ModelDescription model = Table1Model({effect});
      model.parameters.mgl = 300;
      model.units.linear_arm = linear;
      EXPECT_LT(Difference(model, {.arm = 0.1}), 1e-9) << id << (linear ? ", linear" : "");
    }
  }
}

// Tests the same of rigs that nobody chose, held and free, from other pressures than p_3.
TEST(Units, DrawnRigsAreTheSameInAll) {
  for (int i = 0; i < 60; ++i) {
    Random random(20261126, static_cast<uint64_t>(i));
    const bool linear = i % 2 == 1;
    const model::ModelDescription model = DrawnRig(random, linear);
    Start start = {.shaft = i % 4 == 3 ? model::Shaft::kClamped : model::Shaft::kFree,
                   .arm = 0.4 * (random.Unit() - 0.5)};
    if (i % 3 == 0) start.pressure = model.parameters.p_3 * (1 + random.Unit());
    std::string effects;
    for (const auto& effect : model.effects) effects += " " + effect.id;
    try {
      EXPECT_LT(Difference(model, start), 1e-9) << i << effects;
    } catch (const model::ModelError& error) {
      // Not every draw is a rig: two effects may exclude each other, or the arm may leave its cylinder.
      ADD_FAILURE() << i << effects << ": " << error.what();
    }
  }
}

// Tests that a linear arm falls with its weight alone, m x'' = -mgl, wherever it stands and whatever its
// position is in; eq. (15)'s cosine is that of an arm that turns.
TEST(Units, ALinearArmsWeightIsTheSameEverywhere) {
  for (const UnitSystem& system : kSystems) {
    model::ModelDescription inches = Table1Model();
    inches.parameters.mgl = 300;
    const model::ModelDescription turning = InUnits(inches, system);
    inches.units.linear_arm = true;
    const model::ModelDescription model = InUnits(inches, WithArm(system, true));
    for (const double share : {0.0, 0.5}) {  // of the stroke to its end
      const model::Equations equations(model, {});
      double state[model::kMaxStates];
      model::Mode mode;
      equations.Start(std::nan(""), state, &mode);
      state[model::kArmAngle] = share * model.parameters.V_ms / model.parameters.c;
      double rate[model::kMaxStates];
      equations.Rates(0, 0, mode, state, rate);
      EXPECT_DOUBLE_EQ(rate[model::kArmSpeed], -model.parameters.mgl / model.parameters.J_a) << system.length;
    }
    const model::Equations equations(turning, {.arm_angle = 0.5});
    double state[model::kMaxStates], rate[model::kMaxStates];
    model::Mode mode;
    equations.Start(std::nan(""), state, &mode);
    equations.Rates(0, 0, mode, state, rate);
    EXPECT_NEAR(rate[model::kArmSpeed] / (-turning.parameters.mgl / turning.parameters.J_a), std::cos(0.5),
                1e-12);
  }
}

// Tests that the energy that a linear arm's weight takes is that of its height, so that nothing is lost.
TEST(Units, ALinearArmsPowerIsInBalance) {
  model::ModelDescription model = Table1Model();
  model.units.linear_arm = true;
  model.parameters.mgl = 300;
  const model::Equations equations(model, {.arm_angle = 0.4});
  double state[model::kMaxStates];
  model::Mode mode;
  equations.Start(std::nan(""), state, &mode);
  state[model::kArmSpeed] = 2;
  const model::Power power = equations.PowerBalance(0, 0, mode, state);
  EXPECT_DOUBLE_EQ(power.gravity, 600);
}

// Tests that refusals name the model's own units.
TEST(Units, RefusalsAreInTheModelsUnits) {
  const auto refusal = [](const UnitSystem& units, const model::ActuatorOptions& options) -> std::string {
    model::ModelDescription first = Table1Model();
    first.units.linear_arm = units.linear_arm;
    try {
      model::Actuator actuator(InUnits(first, units), options);
    } catch (const model::ModelError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(refusal({"in", "lbf"}, {.arm_angle = 1}),
            "arm angle 1 rad leaves V_1 = -0.52379 in^3; V_1, V_2 > 0 needs |alpha| < 0.857812 rad");
  EXPECT_EQ(refusal({"mm", "N", true}, {.arm_angle = 25}),
            "arm position 25 mm leaves V_1 = -7632.73 mm^3; V_1, V_2 > 0 needs |alpha| < 21.7884 mm");
  EXPECT_EQ(refusal({"m", "N"}, {.initial_pressure = 100}),
            "initial pressure 100 Pa is below the accumulator's p_3 = 689476 Pa");
}

}  // namespace
}  // namespace hydro::testing
