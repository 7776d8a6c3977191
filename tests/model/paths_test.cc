// The integration paths against each other, where no reference exists: every way to hold the shaft, the
// bypass, every effect.
#include <gtest/gtest.h>

#include <cmath>
#include <ostream>

#include "model/trajectory/trajectory.h"
#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

struct Case {
  std::string name;
  model::ModelDescription model;
  model::ActuatorOptions options;
};

std::ostream& operator<<(std::ostream& out, const Case& c) { return out << c.name; }

std::vector<Case> Cases() {
  static const auto sine = trajectory::MakeSine(0, 0.008, 2, 0.02, 0);
  static const auto zigzag =
      trajectory::MakePoints({{0, 0}, {0.05, 0.0015}, {0.1001, -0.001}, {0.2, -0.001}, {0.31, 0.003}},
                             trajectory::Interpolation::kLinear);
  std::vector<Case> cases;
  const auto add = [&](std::string name, std::vector<model::EffectDescription> effects,
                       model::ActuatorOptions options) {
    cases.push_back({std::move(name), Table1Model(std::move(effects)), options});
  };
  add("Clamped", {}, Held(model::Shaft::kClamped));
  add("Free", {}, Held(model::Shaft::kFree));
  add("FreeWithGravity", {}, Held(model::Shaft::kFree));
  cases.back().model.parameters.mgl = 562;
  cases.back().options.arm_angle = -0.3;
  model::ActuatorOptions driven = Held(model::Shaft::kDriven);
  driven.motion = sine.get();
  add("DrivenBySine", {}, driven);
  driven.motion = zigzag.get();
  add("DrivenAlongLines", {}, driven);
  model::ActuatorOptions bypass = Held(model::Shaft::kClamped);
  bypass.bypass = true;
  bypass.initial_pressure = 250;
  add("Bypass", {}, bypass);
  bypass.shaft = model::Shaft::kFree;
  add("BypassFree", {}, bypass);
  add("PressureFriction", {{"pump.pressure_friction", {{"f", 0.001}}, {}}}, Held(model::Shaft::kClamped));
  add("Stribeck", {Stribeck(0.5, 3)}, Held(model::Shaft::kClamped));
  add("StribeckNarrow", {Stribeck(0.5, 0.02)}, Held(model::Shaft::kClamped));
  add("StribeckFree", {Stribeck(0.5, 3)}, Held(model::Shaft::kFree));
  add("Lag", {Lag(2e-3)}, Held(model::Shaft::kClamped));
  add("Wave", {Wave(300, 0.2, 0.05)}, Held(model::Shaft::kClamped));
  add("WaveFree", {Wave(300, 0.2, 0.05)}, Held(model::Shaft::kFree));
  add("WaveBypass", {Wave(300, 0.2, 0.05)}, bypass);
  add("QuadraticDrag", {{"pump.quadratic_drag", {{"k", 1e-3}}, {}}}, Held(model::Shaft::kClamped));
  add("ShearThinning", {{"pump.shear_thinning", {{"viscous", 0.05}, {"speed", 3}}, {}}},
      Held(model::Shaft::kClamped));
  add("PressureOffset", {{"sensor.pressure_offset", {{"p1", 3}, {"p2", -2}}, {}}},
      Held(model::Shaft::kClamped));
  add("PressureDrift", {{"sensor.pressure_drift", {{"p1", 20}, {"p2", -30}}, {}}},
      Held(model::Shaft::kClamped));
  add("Bias", {{"amp.bias", {{"bias", 0.6}}, {}}}, Held(model::Shaft::kFree));
  add("Delay", {{"amp.delay", {{"delay", 3.33e-4}}, {}}}, Held(model::Shaft::kClamped));
  add("DelayAndLag", {{"amp.delay", {{"delay", 4e-4}}, {}}, Lag(2e-3)}, Held(model::Shaft::kFree));
  add("Warming", {{"fluid.warming", {{"rate", 2}}, {}}}, Held(model::Shaft::kClamped));
  add("FrictionAsymmetry", {{"pump.friction_asymmetry", {{"coulomb", 1}, {"viscous", 0.01}}, {}}},
      Held(model::Shaft::kClamped));
  add("SealFriction", {{"actuator.seal_friction", {{"coulomb", 100}, {"viscous", 50}}, {}}},
      Held(model::Shaft::kFree));
  add("SealFrictionWithGravity", {{"actuator.seal_friction", {{"coulomb", 600}, {"viscous", 0}}, {}}},
      Held(model::Shaft::kFree));
  cases.back().model.parameters.mgl = 562;
  add("TurbulentLeakage", {{"pump.turbulent_leakage", {{"k", 1e-3}}, {}}}, Held(model::Shaft::kClamped));
  add("Relief", {{"valve.relief", {{"set", 250}, {"conductance", 1e-3}}, {}}}, Held(model::Shaft::kClamped));
  add("ReliefBypass", {{"valve.relief", {{"set", 200}, {"conductance", 1e-4}}, {}}}, bypass);
  add("EntrainedAir", {{"fluid.entrained_air", {{"air_fraction", 0.02}}, {}}}, Held(model::Shaft::kClamped));
  add("Stiffening", {{"fluid.stiffening", {{"slope", 100}}, {}}}, Held(model::Shaft::kFree));
  add("SpeedTorqueLimit", {{"motor.speed_torque_limit", {{"no_load_speed", 5}}, {}}},
      Held(model::Shaft::kClamped));
  add("SpeedTorqueLimitAndLag", {{"motor.speed_torque_limit", {{"no_load_speed", 5}}, {}}, Lag(2e-3)},
      Held(model::Shaft::kFree));
  add("PressureLag", {{"sensor.pressure_lag", {{"tau", 3e-3}}, {}}}, Held(model::Shaft::kClamped));
  add("Cogging", {{"motor.cogging", {{"amplitude", 2}, {"periods", 12}, {"phase", 0.4}}, {}}},
      Held(model::Shaft::kClamped));
  add("FlowRipple", {{"pump.flow_ripple", {{"amplitude", 0.1}, {"periods", 12}}, {}}},
      Held(model::Shaft::kClamped));
  add("Check", {{"valve.check", {{"cracking", 10}, {"conductance", 1e-3}}, {}}},
      Held(model::Shaft::kClamped));
  add("CheckFree", {{"valve.check", {{"cracking", 0}, {"conductance", 1e-2}}, {}}},
      Held(model::Shaft::kFree));
  add("Accumulator", {{"accumulator.stiffness", {{"stiffness", 5e3}}, {}}}, Held(model::Shaft::kClamped));
  add("AccumulatorFree",
      {{"accumulator.stiffness", {{"stiffness", 5e3}}, {}},
       {"valve.relief", {{"set", 150}, {"conductance", 1e-3}}, {}}},
      Held(model::Shaft::kFree));
  add("AccumulatorBypass", {{"accumulator.stiffness", {{"stiffness", 5e3}}, {}}}, bypass);
  add("Sign", {{"sensor.sign", {}, {{"signal", "motor_speed"}}}}, Held(model::Shaft::kClamped));
  add("Skew", {{"sensor.skew", {{"delay", 3.33e-4}}, {{"signal", "p2"}}}}, Held(model::Shaft::kClamped));
  add("Flexure", {{"arm.flexure", {{"stiffness", 2e5}, {"damping", 500}}, {}}}, Held(model::Shaft::kFree));
  add("FlexureAndSealFriction",
      {{"arm.flexure", {{"stiffness", 2e5}, {"damping", 500}}, {}},
       {"actuator.seal_friction", {{"coulomb", 100}, {"viscous", 50}}, {}}},
      Held(model::Shaft::kFree));
  add("AllEffects",
      {Stribeck(0.5, 3), Lag(2e-3), Wave(300, 0.2, 0.05), {"pump.pressure_friction", {{"f", 0.001}}, {}}},
      Held(model::Shaft::kFree));
  add("AllOtherEffects",
      {{"accumulator.stiffness", {{"stiffness", 5e3}}, {}},
       {"arm.flexure", {{"stiffness", 2e5}, {"damping", 500}}, {}},
       {"fluid.entrained_air", {{"air_fraction", 0.005}}, {}},
       {"fluid.stiffening", {{"slope", 20}}, {}},
       Wave(300, 0.2, 0.05),
       {"motor.cogging", {{"amplitude", 1}, {"periods", 12}, {"phase", 0.4}}, {}},
       {"motor.speed_torque_limit", {{"no_load_speed", 30}}, {}},
       {"pump.flow_ripple", {{"amplitude", 0.05}, {"periods", 9}}, {}},
       {"pump.turbulent_leakage", {{"k", 1e-4}}, {}},
       {"sensor.pressure_lag", {{"tau", 3e-3}}, {}},
       {"valve.check", {{"cracking", 5}, {"conductance", 1e-2}}, {}},
       {"valve.relief", {{"set", 200}, {"conductance", 1e-3}}, {}}},
      Held(model::Shaft::kFree));
  return cases;
}

class Paths : public ::testing::TestWithParam<Case> {};

// Tests that every path gives the same motion within 1e-3 psi: square waves of open-loop voltage, so that no
// controller hides a difference.
TEST_P(Paths, Agree) {
  const Case& c = GetParam();
  model::ActuatorOptions tight = c.options;
  tight.relative_tolerance = 1e-11;
  tight.integrator = model::Integrator::kErk;
  model::Actuator reference(c.model, tight);
  std::vector<model::Actuator> actuators;
  for (const model::Integrator integrator : kIntegrators) {
    model::ActuatorOptions options = c.options;
    options.integrator = integrator;
    actuators.emplace_back(c.model, options);
  }
  double largest_dp = 0;
  for (int tick = 0; tick < 1500; ++tick) {
    const double voltage = (tick / 300 % 2 == 0 ? 2.6 : -1.7) + 0.4 * std::sin(0.1 * tick);
    const double until = (tick + 1) * 2e-4;
    reference.Advance(voltage, until);
    const model::Measurement expected = reference.Measure();
    largest_dp = std::max(largest_dp, std::abs(expected.p2 - expected.p1));
    for (size_t i = 0; i < actuators.size(); ++i) {
      actuators[i].Advance(voltage, until);
      const model::Measurement m = actuators[i].Measure();
      const std::string where = Name(kIntegrators[i]) + " at " + std::to_string(until) + " s";
      ASSERT_NEAR(m.p1, expected.p1, 1e-3) << where;
      ASSERT_NEAR(m.p2, expected.p2, 1e-3) << where;
      ASSERT_NEAR(m.motor_speed, expected.motor_speed, 1e-4) << where;
      ASSERT_NEAR(m.motor_angle, expected.motor_angle, 1e-5) << where;
      ASSERT_NEAR(m.arm_angle, expected.arm_angle, 1e-7) << where;
      ASSERT_NEAR(m.arm_speed, expected.arm_speed, 1e-5) << where;
    }
  }
  EXPECT_TRUE(c.options.bypass || largest_dp > 5) << "it did not move";
}

// Tests that the sum of many short calls is the same motion as one long call.
TEST_P(Paths, LongCalls) {
  const Case& c = GetParam();
  model::Actuator ticks(c.model, c.options);
  model::Actuator whole(c.model, c.options);
  for (int tick = 0; tick < 1500; ++tick) ticks.Advance(2.1, (tick + 1) * 2e-4);
  whole.Advance(2.1, 0.3);
  EXPECT_NEAR(whole.Measure().p1, ticks.Measure().p1, 1e-3);
  EXPECT_NEAR(whole.Measure().p2, ticks.Measure().p2, 1e-3);
  EXPECT_NEAR(whole.Measure().arm_angle, ticks.Measure().arm_angle, 1e-7);
}

class SymmetricPaths : public ::testing::TestWithParam<Case> {};

// Gravity and a driven shaft are not symmetric, nor are unequal sensors, directions or angles.
std::vector<Case> SymmetricCases() {
  std::vector<Case> cases = Cases();
  std::erase_if(cases, [](const Case& c) {
    return c.options.shaft == model::Shaft::kDriven || c.model.parameters.mgl != 0 ||
           c.name == "PressureOffset" || c.name == "PressureDrift" || c.name == "Bias" ||
           c.name == "FrictionAsymmetry" || c.name == "Cogging" || c.name == "Sign" || c.name == "Skew" ||
           c.name == "AllOtherEffects";
  });
  return cases;
}

// Tests that v -> -v swaps the sides: bit for bit on the fast path; SUNDIALS sums its norms over the states
// in their order, so that there a rounding may choose another step or order, which the tolerance bounds.
TEST_P(SymmetricPaths, Mirror) {
  const Case& c = GetParam();
  for (const model::Integrator integrator : kIntegrators) {
    model::ActuatorOptions options = c.options;
    options.integrator = integrator;
    const bool exact = integrator == model::Integrator::kFast || integrator == model::Integrator::kAuto;
    const double allowed = exact ? 0 : 1e-5;
    model::Actuator a(c.model, options);
    model::Actuator b(c.model, options);
    for (int tick = 0; tick < 1000; ++tick) {
      const double voltage = tick / 300 % 2 == 0 ? 2.6 : -1.7;
      a.Advance(voltage, (tick + 1) * 2e-4);
      b.Advance(-voltage, (tick + 1) * 2e-4);
      ASSERT_NEAR(a.Measure().p1, b.Measure().p2, allowed) << Name(integrator) << " at tick " << tick;
      ASSERT_NEAR(a.Measure().p2, b.Measure().p1, allowed) << Name(integrator) << " at tick " << tick;
      ASSERT_NEAR(a.Measure().motor_speed, -b.Measure().motor_speed, allowed);
      ASSERT_NEAR(a.Measure().arm_angle, -b.Measure().arm_angle, allowed);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Cases, Paths, ::testing::ValuesIn(Cases()),
                         [](const auto& test) { return test.param.name; });

INSTANTIATE_TEST_SUITE_P(Cases, SymmetricPaths, ::testing::ValuesIn(SymmetricCases()),
                         [](const auto& test) { return test.param.name; });

// Tests that the automatic choice leaves the explicit method where stability would slow it down, and loses no
// accuracy.
TEST(Auto, TakesCvodeWhereTheModelIsStiff) {
  const model::ModelDescription stiff = Table1Model({Wave(2e5, 0.3, 5)});
  Rig automatic(stiff, Held(model::Shaft::kClamped, model::Integrator::kAuto));
  Rig explicit_pair(stiff, Held(model::Shaft::kClamped, model::Integrator::kErk));
  EXPECT_EQ(automatic.simulation->in_use(), model::Integrator::kFast);
  for (int tick = 0; tick < 50; ++tick) {
    automatic.simulation->Advance(2.5, (tick + 1) * 2e-4);
    explicit_pair.simulation->Advance(2.5, (tick + 1) * 2e-4);
  }
  EXPECT_EQ(automatic.simulation->in_use(), model::Integrator::kCvode);
  EXPECT_NEAR(automatic.Measure().p2, explicit_pair.Measure().p2, 1e-3);
  Rig plain(Table1Model(), Held(model::Shaft::kClamped, model::Integrator::kAuto));
  plain.simulation->Advance(2.5, 0.5);
  EXPECT_EQ(plain.simulation->in_use(), model::Integrator::kFast);
}

}  // namespace
}  // namespace hydro::testing
