#include "diagnose/say/shown.h"

#include <gtest/gtest.h>

#include <limits>

namespace hydro::diagnose {
namespace {

constexpr double kNone = std::numeric_limits<double>::quiet_NaN();

model::ParameterInfo Info(double min, double max = model::kUnbounded) {
  model::ParameterInfo info;
  info.name = "x";
  info.min = min;
  info.max = max;
  return info;
}

bool Shown(double value, double low, double high, const model::ParameterInfo& info) {
  Estimated estimated{"x", value, low, high, "1", true};
  JudgeInterval(info, &estimated);
  return estimated.shown;
}

// Tests that an interval within a factor of ten either way is one that runs show, and a wider one not, for a
// value that cannot be negative.
TEST(ShownTest, FactorOfTen) {
  const model::ParameterInfo size = Info(0);
  EXPECT_TRUE(Shown(100, 11, 999, size));
  EXPECT_FALSE(Shown(100, 9, 200, size));
  EXPECT_FALSE(Shown(100, 50, 1001, size));
  EXPECT_FALSE(Shown(3000, 0, 6739, size)) << "of an EHA recording";
  EXPECT_TRUE(Shown(100, kNone, kNone, size)) << "it was not estimated";
  EXPECT_TRUE(Shown(24, 24, 24, size)) << "a whole number is exact";
  EXPECT_TRUE(Shown(0, 0, 0, size));
}

// Tests that an interval as wide as what is possible shows nothing, that values of either sign may be near 0,
// and that a phase may be 0.
TEST(ShownTest, RangesAndSigns) {
  const model::ParameterInfo part = Info(0, 1);
  EXPECT_TRUE(Shown(0.5, 0.1, 0.9, part));
  EXPECT_FALSE(Shown(0.5, 0.06, 1.1, part));
  const model::ParameterInfo either = Info(-model::kUnbounded);
  EXPECT_TRUE(Shown(0.5, -0.1, 0.9, either));
  EXPECT_FALSE(Shown(0.5, -6, 7, either));
  EXPECT_TRUE(Shown(-2, -3, -1, either));
  model::ParameterInfo phase = Info(-M_PI, M_PI);
  phase.role = model::Role::kPhase;
  EXPECT_TRUE(Shown(0.01, -0.5, 0.5, phase));
  EXPECT_FALSE(Shown(0.01, -3.2, 3.2, phase));
  phase = Info(-model::kUnbounded);
  phase.role = model::Role::kPhase;
  EXPECT_TRUE(Shown(0.01, -0.5, 0.5, phase));
  EXPECT_FALSE(Shown(1.2, -1.9e6, 1.9e6, phase)) << "of a gear motor";
}

std::string Why(double given, double value, double low, double high, const model::ParameterInfo& info) {
  ChangedParameter changed;
  changed.fitted = {"x", value, low, high, "1", true};
  changed.model = given;
  return WhyRemarkable(info, changed);
}

// Tests that a friction whose interval holds 0 is not called implausible, because there may be none; an
// inertia of 0 is not possible.
TEST(ShownTest, NothingAtAllIsPlausible) {
  const model::ParameterInfo friction = Info(0);
  EXPECT_EQ(Why(6.4, 0.5, -0.2, 1.2, friction), "");
  EXPECT_EQ(Why(6.4, 0.5, 0, 1.2, friction), "");
  EXPECT_EQ(Why(6.4, 0.64, 0.2, 1.2, friction), "moves by a factor of 0.1");
  EXPECT_EQ(Why(6.4, 5, 4, 6, friction), "");
  model::ParameterInfo inertia = Info(0);
  inertia.min_allowed = false;
  EXPECT_EQ(Why(0.01, 0.001, -0.01, 0.02, inertia), "moves by a factor of 0.1");
}

}  // namespace
}  // namespace hydro::diagnose
