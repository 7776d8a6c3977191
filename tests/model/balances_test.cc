// Tests that the balances vanish along exact simulations, that their derivatives are right, and that the
// states of effects are found again along a known motion.
#include "model/balances.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/model/model_case.h"
#include "tests/model/some_of_each.h"

namespace hydro::testing {
namespace {

using model::BalancesOf;
using model::KnownMotion;

constexpr double kStep = 5e-4;  // s
// What balances are measured by: the motor's torque, the pump's flow at 100 rad/s, the arm's torque at 1000
// psi.
constexpr double kTorque = 40, kFlow = 0.8, kArm = 3680;

// A simulation, sampled just before each command acts.
struct Sample {
  KnownMotion motion;
  model::Mode mode;
  model::Measurement read;
  double p_3 = 0;     // at that time
  double torque = 0;  // of the motor
};

double VoltageAt(double t) {
  constexpr double kLevels[] = {5, -3, 8, -6, 12, 2, -11, 3};
  return kLevels[static_cast<int>(t / 0.07) % 8] + 2 * std::sin(2 * M_PI * 4 * t);
}

std::vector<Sample> Simulated(const model::ModelDescription& description,
                              const model::ActuatorOptions& options) {
  Rig rig(description, options);
  std::vector<Sample> samples;
  double voltage = 0;
  for (int k = 0; k < 1600; ++k) {
    const double t = kStep * k;
    if (k > 0) rig.simulation->Advance(voltage, t);
    const double* y = rig.simulation->now().state;
    double rate[model::kMaxStates];
    model::Terms<double> x;
    Sample sample;
    sample.mode = rig.simulation->mode();
    rig.equations.Evaluate(t, voltage, sample.mode, y, rate, &x);
    KnownMotion& at = sample.motion;
    at = {.time = t,
          .voltage = voltage,
          .motor_angle = y[model::kMotorAngle],
          .motor_speed = y[model::kMotorSpeed],
          .motor_acceleration = rate[model::kMotorSpeed],
          .p1 = y[model::kP1],
          .p2 = y[model::kP2],
          .p1_rate = rate[model::kP1],
          .p2_rate = rate[model::kP2],
          .arm_angle = options.arm_angle,
          .pump_direction = static_cast<double>(sample.mode.pump)};
    if (options.shaft == model::Shaft::kFree) {
      at.arm_angle = y[model::kArmAngle];
      at.arm_speed = y[model::kArmSpeed];
      at.arm_acceleration = rate[model::kArmSpeed];
      at.arm_direction = at.arm_speed < 0 ? -1 : at.arm_speed > 0 ? 1 : 0;
    }
    sample.read = rig.Measure();
    sample.p_3 = x.p_3;
    sample.torque = x.torque;
    samples.push_back(sample);
    voltage = VoltageAt(t);
  }
  return samples;
}

// How the machine is held, and at which pressure it starts.
std::vector<model::ActuatorOptions> AllWays() {
  model::ActuatorOptions clamped = Held(model::Shaft::kClamped), low = clamped,
                         free = Held(model::Shaft::kFree), bypass = clamped;
  clamped.arm_angle = 0.2;
  clamped.initial_pressure = 1500;
  free.arm_angle = -0.1;
  free.initial_pressure = 1000;
  bypass.bypass = true;
  bypass.initial_pressure = 300;
  return {clamped, low, free, bypass};
}

// Delays between two samples, so that no command acts at a sample.
model::EffectDescription Effect(const model::EffectInfo& info) {
  model::EffectDescription effect = ExampleOf(info);
  if (DelaysCommands(info)) effect.parameters.begin()->second = 3.5 * kStep;
  return effect;
}

// The largest of what is left, relative to what it is measured by, where each balance holds.
struct Left {
  double torque = 0, flow = 0, arm = 0, level = 0, drive = 0, reading = 0;
};

// What the balances of `description` leave along the motion of `machine`.
Left LeftAlong(const model::ModelDescription& machine, const model::ModelDescription& description,
               const model::ActuatorOptions& options) {
  const std::vector<Sample> samples = Simulated(machine, options);
  model::BalanceEquations equations(description, options);
  equations.Start(samples[0].motion);
  Left most;
  const auto more = [](double value, double scale, double* to) {
    *to = std::max(*to, std::abs(value) / scale);
  };
  for (size_t k = 1; k < samples.size(); ++k) {
    const Sample& at = samples[k];
    // The command of a sample acts from then on; here each is just before.
    KnownMotion from = samples[k - 1].motion;
    from.voltage = at.motion.voltage;
    equations.Advance(from, at.motion);
    const BalancesOf<double> left = equations.Values(at.motion);
    if (at.mode.pump != 0) more(left.torque, kTorque, &most.torque);
    if (at.mode.valve_1 == 0) more(left.flow_1, kFlow, &most.flow);
    if (at.mode.valve_2 == 0 && !options.bypass) more(left.flow_2, kFlow, &most.flow);
    if (options.shaft == model::Shaft::kFree && at.motion.arm_speed != 0) more(left.arm, kArm, &most.arm);
    if (at.mode.valve_1 != 0) more(left.level_1, 100, &most.level);
    if (at.mode.valve_2 != 0) more(left.level_2, 100, &most.level);
    more(left.drive - at.torque, kTorque, &most.drive);
    const model::ReadingErrors errors = equations.Errors(at.motion);
    more(errors.p1 + at.motion.p1 - at.read.p1, 1000, &most.reading);
    more(errors.p2 + at.motion.p2 - at.read.p2, 1000, &most.reading);
  }
  return most;
}

// Tests that nothing is left along an exact simulation: of Table 1, and with each effect that has no state.
TEST(Balances, VanishAlongTheMotion) {
  std::vector<model::EffectDescription> effects = {{}};
  for (const model::EffectInfo& info : model::EffectCatalogue()) effects.push_back(Effect(info));
  for (const model::EffectDescription& effect : effects) {
    const model::ModelDescription machine = effect.id.empty() ? Table1Model() : Table1Model({effect});
    for (const model::ActuatorOptions& options : AllWays()) {
      if (model::BalanceEquations(machine, options).has_states()) continue;
      const Left left = LeftAlong(machine, machine, options);
      const std::string what = effect.id + (options.bypass                         ? " bypass"
                                            : options.shaft == model::Shaft::kFree ? " free"
                                                                                   : " clamped");
      EXPECT_LT(left.torque, 1e-9) << what;
      EXPECT_LT(left.flow, 1e-9) << what;
      EXPECT_LT(left.arm, 1e-9) << what;
      EXPECT_LT(left.level, 1e-9) << what;
      EXPECT_LT(left.drive, 1e-9) << what;
      // A late channel is met to second order in how late it is, and not across jumps of its rate.
      EXPECT_LT(left.reading, effect.id == "sensor.skew" ? 0.05 : 1e-9) << what;
    }
  }
}

// Tests that effects with states leave little: these are integrated along samples of the motion, which is not
// smooth where the command jumps.
TEST(Balances, FollowTheStatesOfEffects) {
  size_t tested = 0;
  for (const model::EffectInfo& info : model::EffectCatalogue()) {
    // Teeth meet, and a command is reached, between samples: nobody looks for these by their balances.
    if (info.id == "gear.backlash" || info.id == "amp.rate_limit") continue;
    const model::ModelDescription machine = Table1Model({Effect(info)});
    for (const model::ActuatorOptions& options : AllWays()) {
      if (!model::BalanceEquations(machine, options).has_states()) continue;
      ++tested;
      const Left left = LeftAlong(machine, machine, options);
      const std::string what = info.id + (options.bypass                         ? " bypass"
                                          : options.shaft == model::Shaft::kFree ? " free"
                                                                                 : " clamped");
      EXPECT_LT(left.torque, 5e-3) << what;
      EXPECT_LT(left.flow, 5e-3) << what;
      EXPECT_LT(left.arm, 5e-3) << what;
      EXPECT_LT(left.level, 2e-2) << what;
      EXPECT_LT(left.drive, 5e-3) << what;
      EXPECT_LT(left.reading, 5e-3) << what;
    }
  }
  EXPECT_GE(tested, 5 * AllWays().size());
}

// Tests that an accumulator's pressure is found again where displacement and leakage are wrong: what the
// pump moves leaves one side and enters the other, so the oil that the sides hold says what the accumulator
// has.
TEST(Balances, FollowTheAccumulatorWithWrongFlows) {
  const model::ModelDescription machine = Table1Model({{"accumulator.stiffness", {{"stiffness", 3e3}}, {}}});
  model::ModelDescription wrong = machine;
  wrong.parameters.D *= 1.05;
  wrong.parameters.c_I *= 2;
  for (const model::ActuatorOptions& options : AllWays()) {
    const Left left = LeftAlong(machine, wrong, options);
    EXPECT_LT(left.level, 2e-2) << options.initial_pressure;
    if (!options.bypass) {
      EXPECT_GT(left.flow, 2e-2) << "nothing is wrong";
    }
  }
}

// Expects At's derivative by unknown `u` to be the difference quotient of the machines beside.
void ExpectDerivative(const model::ModelDescription& machine, const model::ModelDescription& up,
                      const model::ModelDescription& down, double width,
                      const model::ActuatorOptions& options, model::Unknown unknown,
                      const std::vector<Sample>& samples, const std::string& what) {
  const model::BalanceEquations at(machine, options, {unknown}), above(up, options), below(down, options);
  for (size_t k = 7; k < samples.size(); k += 31) {
    const KnownMotion& motion = samples[k].motion;
    if (motion.pump_direction == 0) continue;
    const BalancesOf<model::Jet> found = at.At(motion);
    const BalancesOf<double> more = above.Values(motion), less = below.Values(motion),
                             here = at.Values(motion);
    const auto expect = [&](const char* name, const model::Jet& jet, double plus, double minus,
                            double scale) {
      EXPECT_NEAR(jet.v[0] * width, plus - minus, 1e-5 * (std::abs(plus - minus) + 1e-4 * scale))
          << what << " " << name << " at " << motion.time;
    };
    expect("torque", found.torque, more.torque, less.torque, kTorque);
    expect("flow 1", found.flow_1, more.flow_1, less.flow_1, kFlow);
    expect("flow 2", found.flow_2, more.flow_2, less.flow_2, kFlow);
    if (options.shaft == model::Shaft::kFree) expect("arm", found.arm, more.arm, less.arm, kArm);
    expect("drive", found.drive, more.drive, less.drive, kTorque);
    EXPECT_NEAR(found.torque.a, here.torque, 1e-9 * kTorque) << what;
  }
}

// Tests derivatives by base parameters.
TEST(Balances, DerivativesByBaseParametersAreDifferenceQuotients) {
  for (const model::ActuatorOptions& options : AllWays()) {
    const std::vector<Sample> samples = Simulated(Table1Model(), options);
    for (size_t i = 0; i < model::BaseParameters().size(); ++i) {
      const model::BaseParameter& base = model::BaseParameters()[i];
      model::ModelDescription machine = Table1Model(), up = machine, down = machine;
      const double value = machine.parameters.*base.member;
      const double step = value != 0 ? 1e-4 * value : base.info.name == "f" ? 1e-5 : 1;
      up.parameters.*base.member += step;
      down.parameters.*base.member -= step;
      // Values below 0 are no machine's.
      if (value == 0) down = machine;
      ExpectDerivative(machine, up, down, value == 0 ? step : 2 * step, options,
                       {model::Unknown::Kind::kBase, i}, samples, base.info.name);
    }
  }
}

// Tests derivatives by the parameters of each effect without states.
TEST(Balances, DerivativesByEffectsAreDifferenceQuotients) {
  for (const model::EffectInfo& info : model::EffectCatalogue()) {
    if (DelaysCommands(info)) continue;
    const model::ModelDescription machine = Table1Model({Effect(info)});
    for (const model::ActuatorOptions& options : AllWays()) {
      if (model::BalanceEquations(machine, options).has_states()) continue;
      const std::vector<Sample> samples = Simulated(machine, options);
      size_t place = 0;  // among the parameters that are numbers
      for (const model::ParameterInfo& parameter : info.parameters) {
        if (!parameter.is_number()) continue;
        model::ModelDescription up = machine, down = machine;
        const double value = machine.effects[0].parameters.at(parameter.name), step = 1e-4 * value;
        up.effects[0].parameters[parameter.name] = value + step;
        down.effects[0].parameters[parameter.name] = value - step;
        ExpectDerivative(machine, up, down, 2 * step, options, {model::Unknown::Kind::kEffect, place++},
                         samples, info.id + "." + parameter.name);
      }
    }
  }
}

// Tests that a command that acts late does so between samples: the torque just before and how early before
// the sample's end.
TEST(Balances, SayWhenALateCommandActed) {
  const model::ModelDescription machine = Table1Model({{"amp.delay", {{"delay", 2.25 * kStep}}, {}}});
  model::BalanceEquations equations(machine, Held(model::Shaft::kClamped));
  EXPECT_TRUE(equations.remembers());
  EXPECT_FALSE(equations.has_states());
  std::vector<KnownMotion> motion(8);
  for (size_t k = 0; k < motion.size(); ++k) {
    motion[k].time = kStep * static_cast<double>(k);
    motion[k].p1 = motion[k].p2 = 100;
    motion[k].voltage = k < 2 ? 0 : 5;
    motion[k].pump_direction = 1;
  }
  equations.Start(motion[0]);
  std::vector<double> drive(motion.size());
  for (size_t k = 1; k < motion.size(); ++k) {
    equations.Advance(motion[k - 1], motion[k]);
    drive[k] = equations.Values(motion[k]).drive;
    if (k < 3) continue;
    EXPECT_NEAR(equations.early(), 0.75, 1e-6) << k;
    EXPECT_EQ(equations.DriveBefore(motion[k], motion[k - 1].voltage), drive[k - 1]) << k;
  }
  EXPECT_EQ(drive[4], 0);
  EXPECT_EQ(drive[5], 20);  // given at 2, acts at 4.25
}

}  // namespace
}  // namespace hydro::testing
