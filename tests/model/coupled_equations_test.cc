// Tests that two coupled actuators move as the equations of both together do, integrated here by hand: eqs.
// (4), (13), (14) of each pump, which slips forward with closed valves, and the textbook's M alpha'' + bias =
// k_2 dp of two links.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "model/coupled_arm.h"
#include "tests/model/model_case.h"

namespace hydro::model {
namespace {

constexpr double kArmTick = 1e-3;
constexpr int kTicks = 200;
constexpr double kGravity = 386.09;
constexpr double kPressure = 2000;
const ArmLink kUpper = {.mass = 0.06, .length = 22, .centre = 9, .inertia = 2.5};
const ArmLink kLower = {.mass = 0.04, .length = 17, .centre = 8, .inertia = 1.1};
constexpr std::array<double, 2> kStart = {0.3, -0.2};

double JointVoltage(int joint, int tick) { return 6 + 2 * std::sin(0.25 * tick + 2 * joint); }

// Of each joint: theta', p1, p2, alpha, alpha'.
using JointStates = std::array<double, 10>;

JointStates JointRates(const JointStates& y, const std::array<double, 2>& voltage) {
  const Parameters p = testing::Table1();
  JointStates rate{};
  std::array<double, 2> torque{};
  for (size_t i = 0; i < 2; ++i) {
    const double w = y[5 * i], p1 = y[5 * i + 1], p2 = y[5 * i + 2], alpha = y[5 * i + 3],
                 speed = y[5 * i + 4];
    const double dp = p2 - p1;
    rate[5 * i] = (p.k_1 * voltage[i] - p.D * dp - p.b * w - p.T_s) / p.J;
    rate[5 * i + 1] =
        -p.beta / (p.V_ms - p.c * alpha) * (p.D * w - p.c_I * dp + p.c_E * (p1 - p.p_3) - p.c * speed);
    rate[5 * i + 2] =
        -p.beta / (p.V_ms + p.c * alpha) * (-p.D * w + p.c_I * dp + p.c_E * (p2 - p.p_3) + p.c * speed);
    rate[5 * i + 3] = speed;
    torque[i] = p.k_2 * dp;
  }
  const double q1 = y[3], v1 = y[4], q2 = y[8], v2 = y[9];
  const double m1 = kUpper.mass, l1 = kUpper.length, c1 = kUpper.centre, m2 = kLower.mass, c2 = kLower.centre;
  const double d11 =
      m1 * c1 * c1 + m2 * (l1 * l1 + c2 * c2 + 2 * l1 * c2 * std::cos(q2)) + kUpper.inertia + kLower.inertia;
  const double d12 = m2 * (c2 * c2 + l1 * c2 * std::cos(q2)) + kLower.inertia;
  const double d22 = m2 * c2 * c2 + kLower.inertia;
  const double h = -m2 * l1 * c2 * std::sin(q2);
  const double g2 = m2 * c2 * kGravity * std::cos(q1 + q2);
  const double g1 = (m1 * c1 + m2 * l1) * kGravity * std::cos(q1) + g2;
  const double r1 = torque[0] - g1 - 2 * h * v1 * v2 - h * v2 * v2;
  const double r2 = torque[1] - g2 + h * v1 * v1;
  const double determinant = d11 * d22 - d12 * d12;
  rate[4] = (d22 * r1 - d12 * r2) / determinant;
  rate[9] = (d11 * r2 - d12 * r1) / determinant;
  return rate;
}

// Classical Runge-Kutta with steps so short that its error does not count.
JointStates IntegratedByHand() {
  constexpr int kSteps = 250;  // in a tick
  constexpr double h = kArmTick / kSteps;
  JointStates y{};
  for (size_t i = 0; i < 2; ++i) {
    y[5 * i + 1] = y[5 * i + 2] = kPressure;
    y[5 * i + 3] = kStart[i];
  }
  const auto plus = [](JointStates x, const JointStates& by, double times) {
    for (size_t i = 0; i < x.size(); ++i) x[i] += times * by[i];
    return x;
  };
  for (int k = 0; k < kTicks * kSteps; ++k) {
    const std::array<double, 2> voltage = {JointVoltage(0, k / kSteps), JointVoltage(1, k / kSteps)};
    const JointStates k1 = JointRates(y, voltage), k2 = JointRates(plus(y, k1, h / 2), voltage),
                      k3 = JointRates(plus(y, k2, h / 2), voltage), k4 = JointRates(plus(y, k3, h), voltage);
    for (size_t i = 0; i < y.size(); ++i) y[i] += h / 6 * (k1[i] + 2 * k2[i] + 2 * k3[i] + k4[i]);
    for (const size_t i : {0UL, 5UL}) {  // the mode in which this is valid
      EXPECT_TRUE(y[i] > 0 && y[i + 1] > 100 && y[i + 2] > 100) << "at " << (k + 1) * h << " s";
    }
  }
  return y;
}

JointStates Coupled(const CoupledArmOptions& options, double tolerance) {
  std::vector<ArmJoint> joints;
  for (const double angle : kStart) {
    joints.push_back({testing::Table1Model(),
                      {.arm_angle = angle, .initial_pressure = kPressure, .relative_tolerance = tolerance}});
  }
  CoupledArm arm({.gravity = kGravity, .links = {kUpper, kLower}}, joints, options);
  for (int tick = 0; tick < kTicks; ++tick) {
    arm.Advance(std::array<double, 2>{JointVoltage(0, tick), JointVoltage(1, tick)}, (tick + 1) * kArmTick);
  }
  JointStates y;
  for (int i = 0; i < 2; ++i) {
    const Measurement m = arm.Measure(i);
    const std::array<double, 5> own = {m.motor_speed, m.p1, m.p2, m.arm_angle, m.arm_speed};
    std::copy(own.begin(), own.end(), y.begin() + 5 * i);
  }
  return y;
}

// The largest difference of one of the five quantities.
double Worst(const JointStates& a, const JointStates& b, size_t which) {
  return std::max(std::abs(a[which] - b[which]), std::abs(a[which + 5] - b[which + 5]));
}

// Tests that at the default accuracy pressures agree within 0.1 psi and angles within 1e-6 rad, well below
// any sensor's noise, while the arm moves by some hundredths of a radian.
TEST(CoupledEquations, AgreeAtTheDefaultAccuracy) {
  const JointStates by_hand = IntegratedByHand();
  const JointStates coupled = Coupled({}, ArmJoint().options.relative_tolerance);
  EXPECT_LT(Worst(coupled, by_hand, 0), 1e-3);  // rad/s of the motor
  EXPECT_LT(Worst(coupled, by_hand, 1), 0.1);
  EXPECT_LT(Worst(coupled, by_hand, 2), 0.1);
  EXPECT_LT(Worst(coupled, by_hand, 3), 1e-6);
  EXPECT_LT(Worst(coupled, by_hand, 4), 2e-4);
  EXPECT_GT(std::abs(by_hand[3] - kStart[0]), 0.01) << "it has to move";
  EXPECT_GT(std::abs(by_hand[8] - kStart[1]), 0.01) << "it has to move";
}

// Tests that in smooth motion the error falls with the fourth power of the exchanges' distance, to what the
// actuators' tolerance leaves.
TEST(CoupledEquations, ConvergeWithTheFourthOrder) {
  const JointStates by_hand = IntegratedByHand();
  const auto error = [&](int steps_in_a_tick) {
    const JointStates y =
        Coupled({.longest_step = 1.00001 * kArmTick / steps_in_a_tick, .steps_per_radian = 0.1}, 1e-10);
    return Worst(y, by_hand, 1) + Worst(y, by_hand, 2);
  };
  const double coarse = error(4), middle = error(8), fine = error(16);
  EXPECT_GT(coarse / middle, 12);
  EXPECT_GT(middle / fine, 12);
  EXPECT_LT(error(40), 1e-5);
}

}  // namespace
}  // namespace hydro::model
