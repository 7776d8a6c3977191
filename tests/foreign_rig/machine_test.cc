// The machine against results that are known in closed form.
#include "tests/foreign_rig/machine.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace foreign_rig {
namespace {

void StepFor(Machine* machine, double volts, double seconds) {
  for (int i = 0; i < static_cast<int>(std::lround(seconds / kStep)); ++i) machine->Step(volts);
}

// Nothing that takes energy.
Rig Lossless() {
  Rig rig;
  rig.values.viscous_torque = rig.values.outer_leakage = rig.values.cross_leakage = 0;
  rig.values.dry_torque = 1e-6;
  return rig;
}

Day Pressed() {
  Day day;
  day.pressure_1 = 500;
  day.pressure_2 = 800;
  return day;
}

// Tests that without losses energy stays, over 2 s of swinging, within a part in ten thousand.
TEST(Machine, KeepsEnergy) {
  Machine machine(Lossless(), Pressed());
  const double before = machine.Energy();
  for (int i = 0; i < 100; ++i) {
    StepFor(&machine, 0, 0.02);
    EXPECT_NEAR(machine.Energy() / before, 1, 1e-4);
  }
}

// Tests the clamped oil's natural frequency: w^2 = D^2 (2 beta/V)/J.
TEST(Machine, SwingsAtTheOilsFrequency) {
  const Rig rig = Lossless();
  Machine machine(rig, Pressed());
  const Values& v = rig.values;
  std::vector<double> crossings;
  double before = 1;
  for (int i = 0; i < 150000; ++i) {
    machine.Step(0);
    const double across = machine.pressure_2() - machine.pressure_1();
    if (before < 0 && across >= 0) crossings.push_back(machine.time());
    before = across;
  }
  ASSERT_GE(crossings.size(), 4u);
  const double w = v.displacement * std::sqrt(2 * v.bulk_modulus / v.mid_volume / v.rotor_inertia);
  EXPECT_NEAR((crossings[3] - crossings[0]) / 3, 2 * M_PI / w, 1e-4);
}

// Tests that energy only falls where nothing is put in, with every loss and effect of the mechanics there.
TEST(Machine, LosesEnergyByItself) {
  Rig rig;
  rig.effects.static_excess = 0.5;
  rig.effects.churning = 1;
  rig.effects.orifice = 1e-4;
  Machine machine(rig, Pressed());
  double before = machine.Energy();
  for (int i = 0; i < 100; ++i) {
    StepFor(&machine, 0, 0.005);
    EXPECT_LE(machine.Energy(), before * (1 + 1e-9));
    before = machine.Energy();
  }
}

// Tests the terminal speed with the bypass open: (T - T_s)/b, less the churning where there is some.
TEST(Machine, TerminalSpeed) {
  Day day;
  day.bypass = true;
  Rig rig;
  rig.values.viscous_torque = 0.05;  // so that it is reached soon
  Machine machine(rig, day);
  StepFor(&machine, -3, 8);
  EXPECT_NEAR(machine.motor_speed(), -(12 - 4) / 0.05, 0.05);
  rig.effects.churning = 2;
  Machine churning(rig, day);
  StepFor(&churning, -3, 8);
  const double w = -churning.motor_speed();
  EXPECT_NEAR(0.05 * w + 2 * std::pow(w / 300, 2), 8, 0.01);
}

// Tests that a stalled pump holds the pressure that balances it, and that static friction lets it lie lower.
TEST(Machine, StalledPressure) {
  Rig rig;
  rig.values.outer_leakage = 0;
  rig.values.cross_leakage = 2e-4;  // it settles soon
  Machine machine(rig, Day{});
  StepFor(&machine, 2.5, 6);
  // It creeps to make up for leakage: T - T_s - b w = D dp, D w = c_I dp.
  const Values& v = rig.values;
  const double across = machine.pressure_2() - machine.pressure_1();
  const double w = v.cross_leakage * across / v.displacement;
  EXPECT_NEAR(v.displacement * across, 10 - 4 - v.viscous_torque * w, 0.03);
}

// Tests that the pump sticks below its breakaway torque, which static friction raises, and turns above.
TEST(Machine, BreaksAway) {
  Day day;
  day.bypass = true;
  for (const double excess : {0.0, 0.5}) {
    Rig rig;
    rig.effects.static_excess = excess;
    rig.effects.stribeck_speed = 3;
    const double breakaway = (1 + excess);  // V: T_s is 4 in-lbf, k_1 is 4
    Machine below(rig, day);
    StepFor(&below, 0.97 * breakaway, 1);
    EXPECT_NEAR(below.motor_speed(), 0, 1e-3);
    Machine above(rig, day);
    StepFor(&above, 1.03 * breakaway, 1);
    EXPECT_GT(above.motor_speed(), 1);
  }
}

// Tests that the pressures hold the free arm where it starts, and that it falls when they are let out.
TEST(Machine, ArmIsCarried) {
  Day day;
  day.clamped = false;
  day.arm_angle = 0.2;
  Machine machine(Rig{}, day);
  StepFor(&machine, 0, 0.2);
  EXPECT_NEAR(machine.arm_angle(), 0.2, 2e-4);
  day.bypass = true;
  Machine falling(Rig{}, day);
  StepFor(&falling, 0, 0.05);
  const Values v;
  const double fall = 0.5 * v.arm_weight * std::cos(0.2) / v.arm_inertia * 0.05 * 0.05;
  EXPECT_NEAR(falling.arm_angle(), 0.2 - fall, 0.05 * fall);
}

// Tests that no side falls below the supply with ideal valves, and that a poppet lets it fall by its
// cracking.
TEST(Machine, ValvesFeed) {
  Rig rig;
  Machine ideal(rig, Day{});
  StepFor(&ideal, 3, 0.3);
  EXPECT_GE(ideal.pressure_1(), 100);
  rig.effects.check_cracking = 40;
  rig.effects.check_flow = 0.5;
  Machine poppet(rig, Day{});
  double lowest = 100;
  for (int i = 0; i < 15000; ++i) {
    poppet.Step(3);
    lowest = std::min(lowest, poppet.pressure_1());
  }
  EXPECT_LT(lowest, 61);
  EXPECT_GT(lowest, 20);
}

// Tests that warm oil leaks more and rubs less: terminal speeds are as the viscosities.
TEST(Machine, WarmOilIsThin) {
  Rig rig;
  rig.values.viscous_torque = 0.05;
  Day day;
  day.bypass = true;
  day.celsius = 40;
  Machine cold(rig, day);
  day.celsius = 45;
  Machine warm(rig, day);
  StepFor(&cold, 3, 8);
  StepFor(&warm, 3, 8);
  EXPECT_NEAR(warm.motor_speed() / cold.motor_speed(), 1.2484, 0.01);  // exp(838.7/135 - 838.7/140)
}

// Tests the effect `warming`: the viscosity falls at the stated relative rate at the start.
TEST(Machine, WarmsAtTheStatedRate) {
  Rig rig;
  rig.effects.warming = 0.1;
  rig.effects.warming_time = 15;
  Machine machine(rig, Day{});
  StepFor(&machine, 0, 0.1);
  EXPECT_NEAR((machine.celsius() - 40) / 0.1, 0.1 * 135 * 135 / 838.7, 0.02);
}

// Tests that a delayed command and a late signal are late by what was asked for.
TEST(Machine, DelaysAreAsAsked) {
  Rig rig;
  rig.effects.delay = 0.003;
  rig.effects.skew = 0.002;
  rig.effects.skewed = Signal::kMotorSpeed;
  Day day;
  day.bypass = true;
  Machine machine(rig, day);
  double moved = 0, seen = 0;
  for (int i = 0; i < 1000; ++i) {
    machine.Step(5);
    if (moved == 0 && machine.motor_speed() > 0.01) moved = machine.time();
    if (seen == 0 && machine.Read().speed > 0.01) seen = machine.time();
  }
  EXPECT_NEAR(moved, 0.003, 1e-4);
  EXPECT_NEAR(seen - moved, 0.002, 1e-4);
}

// Tests that a machine that continues from another goes the same way to the bit, with pipes and delays.
TEST(Machine, ContinuesExactly) {
  Rig rig;
  rig.effects.line_delay = 4e-4;
  rig.effects.line_loss = 0.05;
  rig.effects.delay = 0.001;
  Machine first(rig, Day{});
  StepFor(&first, 3, 0.1);
  Machine second(rig, Day{});
  second.ContinueFrom(first);
  StepFor(&first, -2, 0.1);
  StepFor(&second, -2, 0.1);
  EXPECT_EQ(first.pressure_2(), second.pressure_2());
  EXPECT_EQ(first.motor_speed(), second.motor_speed());
}

// Tests that a torque of the day's clock turns the pump one way and, half a wave later, the other way.
TEST(Machine, SlowTorqueComesAndGoes) {
  Rig rig;
  rig.values.dry_torque = 0.01;
  rig.outside.slow_torque = 1;
  for (const double clock : {0.0, std::numbers::pi / 0.86}) {
    Day day;
    day.bypass = true;
    day.clock = clock;
    Machine machine(rig, day);
    StepFor(&machine, 0, 1);
    EXPECT_GT(machine.motor_speed() * (clock == 0 ? -1 : 1), 5);
  }
}

// Tests that play lets the vane turn freely before it takes the arm along.
TEST(Machine, PlayComesFirst) {
  Day day;
  day.clamped = false;
  Rig rig;
  rig.values.arm_weight = 0.01;
  Machine tight(rig, day);
  rig.outside.backlash = 0.01;
  Machine loose(rig, day);
  StepFor(&tight, -4, 0.15);
  StepFor(&loose, -4, 0.15);
  // The arm begins on one side of the play and is driven from the other: it is behind by about the play.
  EXPECT_NEAR(loose.arm_angle() - tight.arm_angle(), 0.01, 0.003);
}

}  // namespace
}  // namespace foreign_rig
