// The terms of effects over their own variables.
#include "diagnose/say/effect_term.h"

#include <gmock/gmock.h>

#include <cmath>

#include "diagnose/say/variables.h"
#include "model/terms/parameter_info.h"
#include "tests/diagnose/small_runs.h"

namespace hydro::testing {
namespace {

using ::testing::IsEmpty;
using ::testing::Not;

std::optional<diagnose::FoundTerm> TermIn(const model::ModelDescription& truth, const std::string& effect) {
  const std::vector<diagnose::RunData> runs = ClampedPair(truth, 0.8, 3);
  return diagnose::TermOf(truth, effect, PointersTo(runs), 2);
}

// Tests that a drag is drawn as pump torque over motor speed: its own term is its equation, and what the runs
// lack without it follows that.
TEST(TermOf, ADragOverMotorSpeed) {
  constexpr double kDrag = 1e-3;
  const auto term = TermIn(Table1With({{"pump.quadratic_drag", {{"k", kDrag}}, {}}}), "pump.quadratic_drag");
  ASSERT_TRUE(term.has_value());
  EXPECT_EQ(term->missing.balance, "pump_torque");
  EXPECT_EQ(term->missing.unit, "in-lbf");
  EXPECT_EQ(term->missing.against, "motor_speed");
  ASSERT_THAT(term->at, Not(IsEmpty()));
  double largest = 0;
  for (size_t i = 0; i < term->at.size(); ++i) {
    const double speed = term->at[i];
    largest = std::max(largest, std::abs(speed));
    // A step of the curve is a sixtieth of the range wide.
    EXPECT_NEAR(term->value[i], -kDrag * speed * std::abs(speed), 0.03 * kDrag * 1e4) << speed;
  }
  EXPECT_GT(largest, 50);
  for (size_t i = 0; i < term->missing.at.size(); ++i) {
    const double speed = term->missing.at[i];
    if (std::abs(speed) < 30) continue;
    EXPECT_LT(term->missing.mean[i] * speed, 0) << "a drag acts against the motion";
  }
}

// Tests that a relief valve, which has switches, is drawn over a pressure: nothing below its setting, and the
// more flow out of that side the higher the pressure is above it.
TEST(TermOf, AReliefValveOverPressure) {
  const auto term =
      TermIn(Table1With({{"valve.relief", {{"set", 200}, {"conductance", 1e-3}}, {}}}), "valve.relief");
  ASSERT_TRUE(term.has_value());
  const bool first = term->missing.balance == "flow_1";
  EXPECT_EQ(term->missing.against, first ? "p1" : "p2");
  EXPECT_EQ(term->missing.against_unit, "psi");
  for (size_t i = 0; i < term->at.size(); ++i) {
    const double expected = -1e-3 * std::max(0.0, term->at[i] - 200);
    EXPECT_NEAR(term->value[i], expected, 0.02) << term->at[i];
  }
  EXPECT_GT(term->at.back(), 250);
}

// Tests that effects that act through time, and effects that the model does not have, have no term.
TEST(TermOf, NoneWhereNothingIsAdded) {
  EXPECT_FALSE(TermIn(Table1With({{"amp.lag", {{"tau", 0.005}}, {}}}), "amp.lag").has_value());
  EXPECT_FALSE(TermIn(Table1With(), "pump.stribeck").has_value());
}

// Tests that every variable in the table of effects is one that the runs have.
TEST(OwnVariables, AreThoseOfTheRuns) {
  const std::vector<diagnose::RunData> runs = ClampedPair(Table1With(), 0.2, 3);
  const std::vector<const diagnose::RunData*> pointers = PointersTo(runs);
  const std::vector<diagnose::LackingRun> lacking = diagnose::LackingIn(Table1With(), pointers, 1);
  size_t rows = 0;
  for (const model::EffectInfo& info : model::EffectCatalogue()) {
    for (const diagnose::OwnVariable& own : diagnose::OwnVariables({info.id, {{"periods", 9}}, {}})) {
      bool there = false;
      for (const diagnose::Variable& variable : MotionVariables(lacking, own.balance, {}, true)) {
        there = there || variable.name == own.variable;
      }
      EXPECT_TRUE(there) << info.id << ": " << own.variable;
      ++rows;
    }
  }
  EXPECT_GT(rows, 15u);
}

}  // namespace
}  // namespace hydro::testing
