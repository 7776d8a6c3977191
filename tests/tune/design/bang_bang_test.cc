#include "tune/design/bang_bang.h"

#include <gtest/gtest.h>

#include <cmath>

#include "experiments/runs/shipped_models.h"

namespace hydro::design {
namespace {

using experiments::ShippedModel;

// Tests that without friction the result is the double integrator's closed form: 2
// sqrt(distance/acceleration).
TEST(BangBang, DoubleIntegrator) {
  const RigidDrive drive{.inertia = 5, .torque = 20, .friction = 0, .viscous = 0, .speed = 1e9};
  const FastestMove move = FastestRestToRest(drive, 0.3);
  EXPECT_NEAR(move.time, 2 * std::sqrt(0.3 / 4), 1e-12);
  EXPECT_NEAR(move.switch_time, std::sqrt(0.3 / 4), 1e-12);
  EXPECT_NEAR(move.peak_speed, std::sqrt(0.3 * 4), 1e-12);
  EXPECT_FALSE(move.speed_limited);
  // Into the band: the move to 1.02 of it, less the braking over the last 0.04 of it.
  EXPECT_NEAR(FastestSettling(drive, 0.3, 0.02), 2 * std::sqrt(0.306 / 4) - std::sqrt(2 * 0.012 / 4), 1e-12);
  EXPECT_NEAR(FastestSettling(drive, 0.3, 0), move.time, 1e-12);
}

// Tests that a speed limit gives the closed form of the trapezoid.
TEST(BangBang, SpeedLimit) {
  const RigidDrive drive{.inertia = 5, .torque = 20, .friction = 0, .viscous = 0, .speed = 0.5};
  const FastestMove move = FastestRestToRest(drive, 0.3);
  EXPECT_TRUE(move.speed_limited);
  EXPECT_NEAR(move.time, 0.3 / 0.5 + 0.5 / 4, 1e-12);
}

// Tests that friction, which helps braking, and viscosity enter as in a simulation of the motion, and that
// switching nearer or later misses the target.
TEST(BangBang, EqualsSimulationWithFriction) {
  const RigidDrive drive = MakeRigidDrive(ShippedModel("table1").parameters, 628.3);
  const FastestMove move = FastestRestToRest(drive, 0.1);
  const auto stop = [&](double switch_time, double* time) {
    double angle = 0, speed = 0, t = 0;
    const double h = 1e-6;
    while (speed >= 0) {
      const double torque = t < switch_time ? drive.torque : -drive.torque;
      const double rate = (torque - drive.friction - drive.viscous * speed) / drive.inertia;
      angle += h * (speed + h / 2 * rate);
      speed += h * rate;
      t += h;
    }
    *time = t;
    return angle;
  };
  double time = 0;
  EXPECT_NEAR(stop(move.switch_time, &time), 0.1, 1e-6);
  EXPECT_NEAR(time, move.time, 1e-5);
  EXPECT_GT(stop(move.switch_time + 0.001, &time), 0.1004);
  EXPECT_LT(stop(move.switch_time - 0.001, &time), 0.0996);
}

// Tests that Table 1's drive has the reflected inertia of the paper's numbers, and bounds around 0.38 s.
TEST(BangBang, Table1) {
  const model::Parameters p = ShippedModel("table1").parameters;
  const RigidDrive drive = MakeRigidDrive(p, 628.3);
  EXPECT_NEAR(p.J * std::pow(p.c / p.D, 2), 6430, 10);
  EXPECT_NEAR(drive.inertia, 6430 + 23.3, 20);
  EXPECT_NEAR(FastestRestToRest(drive, 0.1).time, 0.38, 0.01);
  EXPECT_LT(FastestSettling(drive, 0.1, 0.02), FastestRestToRest(drive, 0.098).time);
}

}  // namespace
}  // namespace hydro::design
