// Where a closure begins, and what it resembles.
#include "diagnose/closure/curve_start.h"

#include <gmock/gmock.h>

#include <cmath>

#include "diagnose/closure/resemblance.h"
#include "model/actuator.h"
#include "settings/model_file.h"
#include "tests/diagnose/small_runs.h"

namespace hydro::diagnose {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

// Tests that knots reach from the lowest to the highest value, increase, and are as many as asked for at most.
TEST(CurveStart, Knots) {
  PossibleTerm term;
  term.table = {"flow_1", "in^3/s", "p1", "psi", {110, 120, 120.1, 300, 500, 700, 900, 950}, {}, {}};
  term.low = 100;
  term.high = 1000;
  const std::vector<double> knots = CurveOf(term, 8).lists.at("knots");
  EXPECT_EQ(knots.front(), 100);
  EXPECT_EQ(knots.back(), 1000);
  EXPECT_LE(knots.size(), 8u);
  for (size_t i = 1; i < knots.size(); ++i) EXPECT_GT(knots[i], knots[i - 1] + 3);
  PossibleTerm second = term;
  second.table.against = "arm_angle";
  const model::EffectDescription surface = SurfaceOf(term, second);
  EXPECT_THAT(surface.name_lists.at("against"), ElementsAre("p1", "arm_angle"));
  EXPECT_EQ(surface.lists.at("values").size(),
            surface.lists.at("knots").size() * surface.lists.at("knots_2").size());
}

Closure Like(double (*law)(double), double from, double to) {
  Closure closure{.id = "closure.pump_torque",
                  .unit = "in-lbf",
                  .against = {"motor_speed"},
                  .against_units = {"rad/s"},
                  .knots = {{}},
                  .value = {},
                  .low = {},
                  .high = {},
                  .resembles = {}};
  for (int i = 0; i < 10; ++i) {
    const double x = from + (to - from) * i / 9;
    closure.knots[0].push_back(x);
    closure.value.push_back(law(x));
    closure.low.push_back(law(x) - 0.05);
    closure.high.push_back(law(x) + 0.05);
  }
  return closure;
}

// Tests that simple laws are recognised.
TEST(Resemblance, OfSimpleLaws) {
  const struct {
    double (*law)(double);
    double from, to;
    const char* says;
  } laws[] = {
      {[](double) { return 2.0; }, -10, 10, "is constant"},
      {[](double x) { return 0.7 * x; }, -10, 10, "is proportional to motor_speed"},
      {[](double x) { return 3 + 0.7 * x; }, -10, 10, "is a straight line of motor_speed"},
      {[](double x) { return -std::copysign(2 * std::sqrt(std::abs(x)), x); }, -10, 10,
       "grows as the square root of |motor_speed|, against it"},
      {[](double x) { return 0.1 * x * std::abs(x); }, -10, 10, "grows as the square of |motor_speed|"},
      {[](double x) { return 5 * std::sqrt(x); }, 1, 100, "grows as the square root of motor_speed"},
      {[](double x) { return x > 0 ? -3.0 : 3.0; }, -10, 10,
       "changes sign with motor_speed (Coulomb friction), against it"},
      {[](double x) { return std::max(0.0, x - 100.0 / 3); }, 0, 100, "begins above motor_speed = 33 rad/s"},
      {[](double x) { return 0.02 * x * x * x; }, -10, 10, "grows as the cube of |motor_speed|"},
      {[](double x) { return 3 * std::sin(0.9 * x); }, -10, 10, "follows no simple law"},
  };
  for (const auto& one : laws) EXPECT_EQ(Resemblance(Like(one.law, one.from, one.to)), one.says);
}

// Tests that a surface which is one variable times a function of the other is recognised.
TEST(Resemblance, OfASurface) {
  Closure leak{.id = "closure.flow_1",
               .unit = "in^3/s",
               .against = {"arm_angle", "p2 - p1"},
               .against_units = {"rad", "psi"},
               .knots = {{-0.2, 0, 0.2}, {-500, 0, 500, 900}},
               .value = {},
               .low = {},
               .high = {},
               .resembles = {}};
  for (const double angle : leak.knots[0]) {
    for (const double dp : leak.knots[1]) leak.value.push_back(angle * angle * dp);
  }
  EXPECT_EQ(Resemblance(leak), "is proportional to p2 - p1, by a factor that depends on arm_angle");
}

}  // namespace
}  // namespace hydro::diagnose
