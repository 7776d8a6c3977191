// Tests that shapes of effects end where the machine has them, between the points of their grids.
#include "diagnose/evidence/refined_shapes.h"

#include <gtest/gtest.h>

#include "diagnose/evidence/estimated_model.h"
#include "tests/diagnose/evidence/scanned.h"

namespace hydro::testing {
namespace {

using diagnose::ChangeSet;
using diagnose::RefinedShapes;
using diagnose::SetEvidence;

constexpr double kShapeSeconds = 2;

double ShapeOf(Scanned* scanned, const ChangeSet& set, const std::string& name) {
  const RefinedShapes shaped(&scanned->runs, scanned->rows, set);
  EXPECT_TRUE(shaped.any());
  const auto estimated =
      diagnose::ModelOf(scanned->runs, shaped.rows(), set, SetEvidence(shaped.rows()).Fit(set));
  EXPECT_TRUE(estimated.has_value());
  return estimated ? estimated->model.effects.front().parameters.at(name) : 0;
}

// Tests an effect of which more or less may be there: the speed over which static friction falls.
TEST(RefinedShapes, OfAnAmount) {
  constexpr double kSpeed = 14;
  Scanned scanned(ClampedPair(Table1With({{"pump.stribeck", {{"static_excess", 8}, {"speed", kSpeed}}, {}}}),
                              kShapeSeconds, 3),
                  {"pump.stribeck"});
  const ChangeSet best = scanned.Best("pump.stribeck");
  EXPECT_NEAR(ShapeOf(&scanned, best, "speed"), kSpeed, 0.1 * kSpeed);
  const RefinedShapes shaped(&scanned.runs, scanned.rows, best);
  EXPECT_GE(SetEvidence(shaped.rows()).Log(best), SetEvidence(scanned.rows).Log(best) - 0.1);
}

// Tests an effect that is there or not: a lag.
TEST(RefinedShapes, OfAWhole) {
  constexpr double kTau = 4.7e-3;
  Scanned scanned(ClampedPair(Table1With({{"amp.lag", {{"tau", kTau}}, {}}}), kShapeSeconds, 6), {"amp.lag"});
  EXPECT_NEAR(ShapeOf(&scanned, scanned.Best("amp.lag"), "tau"), kTau, 0.05 * kTau);
}

// Tests that variants stand at their grid points again afterwards, and that nothing is made where no effect
// has a shape.
TEST(RefinedShapes, AreTakenBack) {
  Scanned scanned(ClampedPair(Table1With({{"amp.lag", {{"tau", 4.7e-3}}, {}}}), kShapeSeconds, 6),
                  {"amp.lag", "pump.quadratic_drag"});
  const auto variants = scanned.runs.setup().variants;
  const auto units = scanned.runs.meaning();
  ShapeOf(&scanned, scanned.Best("amp.lag"), "tau");
  for (size_t v = 0; v < variants.size(); ++v)
    EXPECT_EQ(scanned.runs.setup().variants[v].at.parameters, variants[v].at.parameters);
  for (size_t i = 0; i < units.size(); ++i) EXPECT_EQ(scanned.runs.meaning()[i].unit, units[i].unit);
  EXPECT_FALSE(RefinedShapes(&scanned.runs, scanned.rows, {"pump.quadratic_drag"}).any());
  EXPECT_FALSE(RefinedShapes(&scanned.runs, scanned.rows, {}).any());
}

}  // namespace
}  // namespace hydro::testing
