#include "tests/foreign_rig/pipe.h"

#include <gtest/gtest.h>

#include <vector>

namespace foreign_rig {
namespace {

constexpr double kStepS = 5e-6;

// Tests that oil at rest stays at rest, also with losses.
TEST(Pipe, RestsAtOnePressure) {
  Pipe pipe(1e-3, 50, 0.05, kStepS);
  pipe.Fill(700);
  for (int i = 0; i < 1000; ++i) {
    EXPECT_EQ(pipe.FlowA(700), 0);
    EXPECT_EQ(pipe.FlowB(700), 0);
    pipe.Step(700, 700);
  }
}

// Tests that a steady flow loses `loss` times impedance times flow.
TEST(Pipe, SteadyFlowLosesPressure) {
  const double impedance = 50, loss = 0.06;
  Pipe pipe(5e-4, impedance, loss, kStepS);
  pipe.Fill(100);
  for (int i = 0; i < 200000; ++i) pipe.Step(110, 100);
  EXPECT_NEAR(pipe.FlowA(110), 10 / (impedance * loss), 1e-3);
  EXPECT_NEAR(pipe.FlowB(100), -10 / (impedance * loss), 1e-3);
}

// Tests that a step arrives after the delay and not before, doubled at a closed end.
TEST(Pipe, WaveArrivesAfterTheDelay) {
  Pipe pipe(1e-3, 50, 0, kStepS);
  pipe.Fill(0);
  double end = 0;
  for (int i = 0; i < 205; ++i) {
    // Closed at b: the pressure at which nothing flows; the impedance is 50.
    end = -50 * pipe.FlowB(0);
    if (i <= 199) {
      EXPECT_EQ(end, 0) << i;
    }
    pipe.Step(10, end);
  }
  EXPECT_NEAR(end, 20, 1e-9);
}

// Tests the quarter-wave resonance of a pipe that is open at one end: it swings with period 4 delay.
TEST(Pipe, QuarterWave) {
  Pipe pipe(1e-3, 50, 0, kStepS);
  pipe.Fill(0);
  std::vector<double> crossings;
  double before = 0;
  for (int i = 0; i < 8000; ++i) {
    const double end = -50 * pipe.FlowB(0);
    if (i > 0 && before < 10 && end >= 10) crossings.push_back(i * kStepS);
    before = end;
    pipe.Step(10, end);
  }
  ASSERT_GE(crossings.size(), 5u);
  EXPECT_NEAR(crossings[4] - crossings[3], 4e-3, 3e-5);
}

}  // namespace
}  // namespace foreign_rig
