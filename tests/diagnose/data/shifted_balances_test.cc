// Balances of shifted signals, on signals made so that they close exactly.
#include "diagnose/data/shifted_balances.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/table1.h"

namespace hydro::diagnose {
namespace {

constexpr Eigen::Index kSamples = 2000;
constexpr double kStep = 0.01;  // s

// A motor that turns back and forth, with pressures of other frequencies.
EvenSignals Closed() {
  EvenSignals even;
  even.step = kStep;
  const auto fill = [](auto value) {
    Eigen::VectorXd signal(kSamples);
    for (Eigen::Index i = 0; i < kSamples; ++i) signal(i) = value(kStep * static_cast<double>(i));
    return signal;
  };
  even.speed = fill([](double t) { return 100 * std::sin(7 * t) + 30 * std::sin(19 * t); });
  even.acceleration = fill([](double t) { return 700 * std::cos(7 * t) + 570 * std::cos(19 * t); });
  even.p1 = fill([](double t) { return 600 + 200 * std::sin(5 * t); });
  even.p2 = fill([](double t) { return 700 + 300 * std::cos(11 * t); });
  even.p1_rate = fill([](double t) { return 1000 * std::cos(5 * t); });
  even.p2_rate = fill([](double t) { return -3300 * std::sin(11 * t); });
  even.voltage = 0.008 * (even.p2 - even.p1) + 0.03 * even.acceleration + 0.015 * even.speed +
                 4 * even.speed.cwiseSign();
  even.arm_speed = 0.02 * even.speed - 1e-4 * even.p1_rate + 2e-4 * even.p2_rate;
  return even;
}

// The signal as a clock records it that is late by that many steps.
Eigen::VectorXd Late(const Eigen::VectorXd& signal, Eigen::Index steps) {
  Eigen::VectorXd late = signal;
  late.tail(signal.size() - steps) = signal.head(signal.size() - steps);
  return late;
}

ShiftedBalances Make(const EvenSignals& even) { return {even, testing::Table1()}; }

// Tests that shifts reach 2 % of the run, and 1 s at most.
TEST(ShiftedBalances, ReachFollowsTheRunsLength) {
  const ShiftedBalances balances = Make(Closed());
  EXPECT_EQ(balances.reach(), 40);
  EXPECT_EQ(balances.begin(), 42);
  EXPECT_EQ(balances.end(), kSamples - 42);
}

// Tests that the torque balance closes where command and speed are shifted back by their delays, and is open
// beside them.
TEST(ShiftedBalances, TorqueClosesAtTheDelays) {
  EvenSignals even = Closed();
  even.voltage = Late(even.voltage, 7);
  even.speed = Late(even.speed, 4);
  even.acceleration = Late(even.acceleration, 4);
  const ShiftedBalances balances = Make(even);
  const auto open = [&](int command, int speed) {
    return balances.Torque(command, speed, balances.begin(), balances.end());
  };
  EXPECT_LT(open(7, 4), 1e-6);
  for (const auto& [command, speed] : {std::pair{0, 0}, {7, 0}, {0, 4}, {7, 5}, {6, 4}}) {
    EXPECT_GT(open(command, speed), 1e-3) << command << ", " << speed;
  }
}

// Tests the same for the flow balance and the arm.
TEST(ShiftedBalances, FlowClosesAtTheArmsDelay) {
  EvenSignals even = Closed();
  even.arm_speed = Late(even.arm_speed, 5);
  const ShiftedBalances balances = Make(even);
  EXPECT_LT(balances.Flow(0, 5, balances.begin(), balances.end()), 1e-6);
  EXPECT_GT(balances.Flow(0, 0, balances.begin(), balances.end()), 1e-2);
  EXPECT_GT(balances.Flow(0, 6, balances.begin(), balances.end()), 1e-3);
}

// Tests that too few samples tell nothing.
TEST(ShiftedBalances, AShortStretchTellsNothing) {
  const ShiftedBalances balances = Make(Closed());
  EXPECT_EQ(balances.Torque(0, 0, 100, 219), std::numeric_limits<double>::infinity());
  EXPECT_EQ(balances.Flow(0, 0, 100, 199), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace hydro::diagnose
