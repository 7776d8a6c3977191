// Tests of both loops without messages: which sample acts when, for each kind of reference, and what a limit
// keeps back. That they are the stack's is tested with whole steps (StepTrial.EqualsTheStack) and re-arms.
#include "tune/design/stack_loops.h"

#include <gtest/gtest.h>

#include <vector>

namespace hydro::design {
namespace {

using settings::ReferenceSignal;

// A pressure loop of 1 V/psi, and a position loop that samples every third tick.
LoopSettings Plain(ReferenceSignal signal, int delay) {
  LoopSettings loops;
  loops.pressure.gains.k_p = 1;
  loops.pressure.voltage_limit = 1000;
  loops.position.pressure_limit = 100;
  loops.position.sample_interval = 0.003;
  loops.interval = 3;
  loops.command_delay = delay;
  loops.signal = signal;
  loops.torque_per_pressure = 2;
  return loops;
}

// The voltages from tick 0 on, for a machine that rests.
std::vector<double> Voltages(const LoopSettings& settings, const std::vector<double>& references) {
  StackLoops loops(settings, 0);
  std::vector<double> voltages;
  for (size_t k = 0; k < references.size(); ++k)
    voltages.push_back(loops.Voltage(static_cast<int64_t>(k), {}, references[k]));
  return voltages;
}

// Tests that a command acts two ticks after the sample that it comes from, each loop adding one, or at once
// where the stack has no delay; and that between samples the reference is not looked at.
TEST(StackLoops, CommandsActWhenTheyDo) {
  const std::vector<double> references = {50, 7, 7, 60, 7, 7};
  for (const ReferenceSignal signal : {ReferenceSignal::kPressure, ReferenceSignal::kVoltage}) {
    EXPECT_EQ(Voltages(Plain(signal, 1), references), (std::vector<double>{0, 0, 50, 50, 50, 60}));
    EXPECT_EQ(Voltages(Plain(signal, 0), references), (std::vector<double>{50, 50, 50, 60, 60, 60}));
  }
  EXPECT_EQ(Voltages(Plain(ReferenceSignal::kTorque, 0), {50, 0, 0}), (std::vector<double>{25, 25, 25}));
}

// Tests that what limits.arm_torque keeps back is told, until a sample asks for less; a voltage is limited by
// the motor alone.
TEST(StackLoops, TellWhatIsHeldBack) {
  const LoopSettings settings = Plain(ReferenceSignal::kPressure, 0);
  StackLoops loops(settings, 0);
  EXPECT_EQ(loops.Voltage(0, {}, 150), 100);
  EXPECT_TRUE(loops.held_back());
  EXPECT_EQ(loops.pressure_ref(), 100);
  EXPECT_EQ(loops.Voltage(1, {}, 50), 100);
  EXPECT_TRUE(loops.held_back());
  EXPECT_EQ(loops.Voltage(3, {}, 50), 50);
  EXPECT_FALSE(loops.held_back());
  EXPECT_EQ(Voltages(Plain(ReferenceSignal::kVoltage, 0), {5000}), std::vector<double>{1000});
}

// Tests that an arm that was moving before is not taken for one that jumped.
TEST(StackLoops, AnArmThatMoves) {
  LoopSettings settings = Plain(ReferenceSignal::kArmAngle, 0);
  settings.position.c2 = 10;
  StackLoops loops(settings, 0.5, 2);
  EXPECT_NEAR(loops.Voltage(0, {.arm_angle = 0.5}, 0.5), -20, 1e-9);
}

}  // namespace
}  // namespace hydro::design
