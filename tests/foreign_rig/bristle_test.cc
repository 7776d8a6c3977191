#include "tests/foreign_rig/bristle.h"

#include <gtest/gtest.h>

#include <cmath>

namespace foreign_rig {
namespace {

constexpr Bristles kPlain{1000, 0, 0.1, 0};
constexpr Bristles kElastic{1000, 0, 0.1, 0.6};
constexpr double kLimit = 4;

// Tests that steady slip in either direction asks for the limit, with and without an elastic range.
TEST(Bristles, SlipAtTheLimit) {
  for (const Bristles& b : {kPlain, kElastic}) {
    for (const double speed : {0.3, -20.0}) {
      double bend = 0;
      for (int i = 0; i < 200000; ++i) bend = Bend(b, bend, speed, kLimit, 1e-5);
      EXPECT_NEAR(BristleForce(b, bend, speed, kLimit), std::copysign(kLimit, speed), 1e-6);
    }
  }
}

// Tests that the bend after a long step is that of LuGre's equation in closed form: full (1 - exp(-|v|
// t/full)).
TEST(Bristles, BendIsExact) {
  const double full = kLimit / kPlain.stiffness;
  const double speed = 0.7, h = 0.01;
  EXPECT_NEAR(Bend(kPlain, 0, speed, kLimit, h), full * (1 - std::exp(-speed * h / full)), 1e-15);
}

// Tests that a push below the elastic range springs back to where it began: nothing creeps.
TEST(Bristles, ElasticRangeDoesNotCreep) {
  double bend = 0;
  double moved = 0;
  for (int i = 0; i < 10000; ++i) {
    const double speed = 0.02 * std::cos(2 * M_PI * i / 1000.0);  // swings of 3e-5 rad
    bend = Bend(kElastic, bend, speed, kLimit, 1e-5);
    moved += speed * 1e-5;
  }
  EXPECT_NEAR(bend, moved, 1e-12);
  // LuGre without the range has slipped.
  bend = 0.5 * kLimit / kPlain.stiffness;
  const double before = bend;
  for (int i = 0; i < 100000; ++i) bend = Bend(kPlain, bend, i % 2 == 0 ? 0.1 : -0.1, kLimit, 1e-4);
  EXPECT_LT(bend, 0.9 * before);
}

// Tests that no closed cycle gives energy.
TEST(Bristles, CyclesLoseEnergy) {
  double bend = 0;
  double work = 0;
  const double h = 1e-5;
  for (int i = 0; i < 100000; ++i) {
    const double speed = 2 * std::sin(2 * M_PI * i / 10000.0);
    const double next = Bend(kElastic, bend, speed, kLimit, h);
    work += 0.5 * kElastic.stiffness * (bend + next) * speed * h;
    bend = next;
    if (i % 10000 == 9999) {
      EXPECT_GT(work, 0) << i;
    }
  }
  // Most of the force over the way: the rest is in turning round.
  const double way = 10 * 2 * 2 * 2 / (2 * M_PI) * 10000 * h;
  EXPECT_GT(work, 0.8 * kLimit * way);
  EXPECT_LT(work, 1.001 * kLimit * way);
}

// Tests that the damping acts on the rate of bending: fully before the bristles slip, not at all in steady
// slip.
TEST(Bristles, DampingActsOnBending) {
  Bristles b = kPlain;
  b.damping = 50;
  EXPECT_NEAR(BristleForce(b, 0, 0.01, kLimit), 50 * 0.01 * std::exp(-0.01), 1e-12);
  EXPECT_NEAR(BristleForce(b, kLimit / b.stiffness, 0.01, kLimit), kLimit, 1e-12);
}

}  // namespace
}  // namespace foreign_rig
