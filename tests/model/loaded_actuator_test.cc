// Tests that an actuator under a load from outside is the actuator of eq. (15) where the load is that of eq.
// (15).
#include "model/loaded_actuator.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/model/model_case.h"

namespace hydro::model {
namespace {

using testing::kFlexure;
using testing::RefusalOf;
using testing::SquareWaveLoop;
using testing::Table1Model;

const EffectDescription kSealFriction = {"actuator.seal_friction", {{"coulomb", 60}, {"viscous", 10}}, {}};

std::vector<std::vector<EffectDescription>> Models() {
  return {{}, {kSealFriction}, {kFlexure}, {kFlexure, kSealFriction}, {testing::Lag(1e-3)}};
}

void ExpectSame(const Measurement& a, const Measurement& b) {
  EXPECT_EQ(a.motor_angle, b.motor_angle);
  EXPECT_EQ(a.motor_speed, b.motor_speed);
  EXPECT_EQ(a.arm_angle, b.arm_angle);
  EXPECT_EQ(a.arm_speed, b.arm_speed);
  EXPECT_EQ(a.p1, b.p1);
  EXPECT_EQ(a.p2, b.p2);
}

// Tests that with the inertia J_a and no torque it runs bit by bit as the actuator without gravity, plain and
// with effects.
TEST(LoadedActuator, WithJaIsTheActuator) {
  for (const auto& effects : Models()) {
    Actuator plain(Table1Model(effects), {});
    LoadedActuator loaded(Table1Model(effects), {});
    loaded.SetLoad({.inertia = testing::Table1().J_a});
    for (int tick = 0; tick < 500; ++tick) {
      const double voltage = SquareWaveLoop(plain.Measure(), tick);
      plain.Advance(voltage, (tick + 1) * 2e-4);
      loaded.Advance(voltage, (tick + 1) * 2e-4);
    }
    ExpectSame(plain.Measure(), loaded.Measure());
    EXPECT_GT(std::abs(loaded.arm_speed()), 1e-3) << "it has to move";
  }
}

// Tests that gravity as a load, given anew every 0.2 ms with its rate and curvature, gives the motion under
// mgl cos(alpha), for every integrator.
TEST(LoadedActuator, GravityAsLoad) {
  for (const Integrator integrator : testing::kIntegrators) {
    ModelDescription model = Table1Model();
    model.parameters.mgl = 400;
    const ActuatorOptions options{.arm_angle = 0.3, .integrator = integrator};
    Actuator plain(model, options);
    LoadedActuator loaded(model, options);
    for (int tick = 0; tick < 1000; ++tick) {
      const double voltage = SquareWaveLoop(plain.Measure(), tick);
      plain.Advance(voltage, (tick + 1) * 2e-4);
      const double a = loaded.arm_angle();
      const double v = loaded.arm_speed();
      loaded.SetLoad({.inertia = model.parameters.J_a,
                      .torque = -400 * std::cos(a),
                      .torque_rate = 400 * std::sin(a) * v,
                      .torque_curve = 200 * std::cos(a) * v * v});
      loaded.Advance(voltage, (tick + 1) * 2e-4);
    }
    // The load misses terms of the third order in 0.2 ms.
    EXPECT_NEAR(loaded.Measure().arm_angle, plain.Measure().arm_angle, 1e-8) << testing::Name(integrator);
    EXPECT_NEAR(loaded.Measure().p1, plain.Measure().p1, 2e-2) << testing::Name(integrator);
    EXPECT_NEAR(loaded.Measure().p2, plain.Measure().p2, 2e-2) << testing::Name(integrator);
    EXPECT_GT(std::abs(plain.Measure().arm_angle - 0.3), 1e-3) << "it has to move";
  }
}

// Tests that friction of the joint says that it holds, and that a load above it lets go.
TEST(LoadedActuator, SealFrictionHolds) {
  LoadedActuator loaded(Table1Model({kSealFriction}), {});
  loaded.SetLoad({.inertia = 20, .torque = 59});
  loaded.Advance(0, 0.01);
  EXPECT_TRUE(loaded.ArmTorque().held);
  EXPECT_EQ(loaded.arm_angle(), 0);
  EXPECT_EQ(loaded.ArmTorque().torque, -59);
  loaded.SetLoad({.inertia = 20, .torque = 61});
  loaded.Advance(0, 0.02);
  EXPECT_FALSE(loaded.ArmTorque().held);
  EXPECT_GT(loaded.arm_angle(), 0);
}

// Tests that a joint that is in balance is not taken for one that is held.
TEST(LoadedActuator, BalanceIsNotFriction) {
  LoadedActuator loaded(Table1Model({testing::Lag(1e-3)}), {});
  EXPECT_EQ(loaded.ArmTorque().torque, 0);
  EXPECT_FALSE(loaded.ArmTorque().held);
}

// Tests that the torque's rate is the derivative of the torque, with friction, which depends on the arm's
// acceleration, and flexure.
TEST(LoadedActuator, TorqueRateIsTheDerivative) {
  for (const auto& effects : Models()) {
    LoadedActuator loaded(Table1Model(effects), {.relative_tolerance = 1e-10});
    loaded.SetLoad({.inertia = 20, .torque = 200, .torque_rate = -3000});
    loaded.Advance(4, 0.01);
    const double before = loaded.ArmTorque().torque;
    constexpr double kStep = 1e-5;
    loaded.Advance(4, 0.01 + kStep);
    const auto middle = loaded.ArmTorque().torque;
    const double acceleration = (middle + 200 - 3000 * (0.01 + kStep)) / 20;
    const double rate = loaded.ArmTorqueRate(acceleration);
    loaded.Advance(4, 0.01 + 2 * kStep);
    EXPECT_NEAR(rate, (loaded.ArmTorque().torque - before) / (2 * kStep), 1e-4 * std::abs(rate) + 0.5);
    EXPECT_GT(std::abs(rate), 100);
  }
}

// Tests that the balance of power closes, with the arm as what takes power from the shaft.
TEST(LoadedActuator, PowerBalances) {
  for (const auto& effects : Models()) {
    LoadedActuator loaded(Table1Model(effects), {});
    loaded.SetLoad({.inertia = 20, .torque = 200, .torque_rate = -3000});
    loaded.Advance(4, 0.03);
    const Power power = loaded.PowerBalance();
    EXPECT_NEAR(power.in + power.shaft_in, power.stored() + power.dissipated() + power.mismatch,
                1e-9 * std::abs(power.in));
    EXPECT_NE(power.shaft_in, 0);
  }
}

// Tests that moving the arm compresses the fluid by c dalpha, and that an open valve holds its side.
TEST(LoadedActuator, MovingTheArmCompressesTheFluid) {
  const Parameters p = testing::Table1();
  LoadedActuator loaded(Table1Model(), {.initial_pressure = 500});
  loaded.Advance(0, 0);
  loaded.MoveArm(1e-5, 0.25);
  EXPECT_NEAR(loaded.Measure().p1, 500 + p.beta / (p.V_ms - p.c * 1e-5) * p.c * 1e-5, 1e-9);
  EXPECT_NEAR(loaded.Measure().p2, 500 - p.beta / (p.V_ms + p.c * 1e-5) * p.c * 1e-5, 1e-9);
  EXPECT_EQ(loaded.arm_angle(), 1e-5);
  EXPECT_EQ(loaded.arm_speed(), 0.25);
}

// Tests that a load that means nothing is refused.
TEST(LoadedActuator, RefusesLoadsWithoutMeaning) {
  LoadedActuator loaded(Table1Model(), {});
  EXPECT_EQ(RefusalOf([&] { loaded.SetLoad({.inertia = 0}); }),
            "inertia of the arm's load = 0; allowed is above 0");
  EXPECT_EQ(RefusalOf([&] { loaded.SetLoad({.inertia = 1, .torque = std::nan("")}); }),
            "the torque of the arm's load is not finite");
  LoadedActuator clamped(Table1Model(), {.shaft = Shaft::kClamped});
  EXPECT_EQ(RefusalOf([&] { clamped.SetLoad({.inertia = 1}); }), "an arm with a load needs a free shaft");
  EXPECT_EQ(RefusalOf([&] { clamped.MoveArm(0, 0); }), "a clamped arm cannot be moved");
  EXPECT_EQ(RefusalOf([] { LoadedActuator(Table1Model(), {.shaft = Shaft::kDriven}); }),
            "a driven shaft needs a motion");
}

}  // namespace
}  // namespace hydro::model
