// What a machine that goes on from another one has of it, and what of a start is free.
#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/foreign_rig/machine.h"

namespace foreign_rig {
namespace {

Day StartsPressed() {
  Day day;
  day.pressure_1 = 500;
  day.pressure_2 = 800;
  return day;
}

// Tests that a machine that goes on from one whose oil has warmed does not learn its temperature.
TEST(MachineStart, TemperatureIsNotHandedOver) {
  Rig rig;
  rig.effects.warming = 0.5;
  Day day = StartsPressed();
  Machine warm(rig, day);
  for (int i = 0; i < 25000; ++i) warm.Step(0);
  EXPECT_GT(warm.celsius(), day.celsius + 1);
  Machine plain(Rig(), day);
  plain.ContinueFrom(warm);
  EXPECT_EQ(plain.celsius(), day.celsius);
  Machine also_warm(rig, day);
  also_warm.ContinueFrom(warm);
  EXPECT_EQ(also_warm.celsius(), warm.celsius());
}

// Tests that a motor at its limit loses torque at the stated rate, slower as it loses, and that a machine
// whose motor does not fade has all of it, also where it goes on from one whose motor does.
TEST(MachineStart, FadingIsNotHandedOver) {
  Rig steady;
  steady.values.dry_torque = steady.values.viscous_torque = 0.001;
  Rig fading = steady;
  fading.outside.motor_fade = 0.5;
  Day day;
  day.bypass = true;
  Machine tired(fading, day);
  for (int i = 0; i < 25000; ++i) tired.Step(i % 2 == 0 ? 20 : -20);
  const auto gain_of = [&](const Rig& rig) {
    Machine machine(rig, day);
    machine.ContinueFrom(tired);
    for (int i = 0; i < 50; ++i) machine.Step(20);
    return machine.motor_speed() - tired.motor_speed();
  };
  const double full = steady.values.torque_limit / steady.values.rotor_inertia * 50 * kStep;
  EXPECT_NEAR(gain_of(steady) / full, 1, 0.01);
  // dx/dt = 0.5 (1 - x)^3 over 0.5 s.
  EXPECT_NEAR(gain_of(fading) / full, 1 / std::sqrt(1.5), 0.01);
}

// Tests which states of a start are free, and that a shift moves what it says.
TEST(MachineStart, StartsCanBeShifted) {
  using Start = Machine::Start;
  Rig rig;
  Day day = StartsPressed();
  EXPECT_EQ(Machine(rig, day).FreeStarts(),
            (std::vector<Start>{Start::kSpeed, Start::kPressure1, Start::kPressure2}));
  day.bypass = true;
  EXPECT_EQ(Machine(rig, day).FreeStarts(), (std::vector<Start>{Start::kSpeed, Start::kPressure1}));
  Machine open(rig, day);
  const double before = open.pressure_2();
  open.Shift(Start::kPressure1, 3);
  EXPECT_EQ(open.pressure_1(), open.pressure_2());
  EXPECT_NEAR(open.pressure_2(), before + 3, 1e-9);
  day.bypass = day.clamped = false;
  rig.effects.cogging = 1;
  Machine free(rig, day);
  EXPECT_EQ(free.FreeStarts().size(), 6u);
  free.Shift(Start::kSpeed, 2);
  free.Shift(Start::kArm, 0.01);
  free.Shift(Start::kArmRate, 0.5);
  free.Shift(Start::kShaft, 0.1);
  EXPECT_EQ(free.motor_speed(), 2);
  EXPECT_EQ(free.arm_angle(), 0.01);
  EXPECT_EQ(free.arm_rate(), 0.5);
  EXPECT_EQ(free.shaft_angle(), 0.1);
}

}  // namespace
}  // namespace foreign_rig
