// Closures of a model that was found, as a diagnosis states them, and what they resemble.
#include "diagnose/fit/closure.h"

#include <gmock/gmock.h>

#include <cmath>

#include "tests/diagnose/small_runs.h"

namespace hydro::diagnose {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

// Friction as the root of speed, as the evidence would find it.
Hypothesis WithFilm() {
  model::EffectDescription film;
  film.id = "closure.pump_torque";
  film.name_lists["against"] = {"motor_speed"};
  for (int k = -8; k <= 8; ++k) {
    const double speed = k * std::abs(k) * 2.0;
    film.lists["knots"].push_back(speed);
    film.lists["values"].push_back(-std::copysign(0.4 * std::sqrt(std::abs(speed) / 10), speed));
  }
  Hypothesis hypothesis;
  hypothesis.model = testing::Table1With({film});
  hypothesis.changes = {{"closure.pump_torque", {}, ""}};
  return hypothesis;
}

// Tests that a closure has its knots, values, units and what it resembles, and a band where its values are
// free.
TEST(FoundClosures, KnotsValuesAndBand) {
  Hypothesis hypothesis = WithFilm();
  std::vector<Closure> closures = FoundClosures(hypothesis, {});
  ASSERT_THAT(closures, SizeIs(1));
  EXPECT_EQ(closures[0].id, "closure.pump_torque");
  EXPECT_THAT(closures[0].against, ElementsAre("motor_speed"));
  EXPECT_THAT(closures[0].against_units, ElementsAre("rad/s"));
  EXPECT_EQ(closures[0].unit, "in-lbf");
  EXPECT_EQ(closures[0].value, hypothesis.model.effects[0].lists["values"]);
  EXPECT_EQ(closures[0].low, closures[0].value) << "its values are held";
  EXPECT_THAT(closures[0].resembles, HasSubstr("square root of |motor_speed|, against it"));

  hypothesis.effects = {"closure.pump_torque"};
  std::vector<Interval> intervals;
  for (const FreeParameter& free : hypothesis.Free())
    intervals.push_back({free.value - 0.1, free.value + 0.2});
  closures = FoundClosures(hypothesis, intervals);
  for (size_t i = 0; i < closures[0].value.size(); ++i) {
    EXPECT_NEAR(closures[0].low[i], closures[0].value[i] - 0.1, 1e-12);
    EXPECT_NEAR(closures[0].high[i], closures[0].value[i] + 0.2, 1e-12);
  }
}

// Tests that a closure that the model as given has is none that was found.
TEST(FoundClosures, NotThoseOfTheModelAsGiven) {
  Hypothesis hypothesis = WithFilm();
  hypothesis.changes.clear();
  EXPECT_THAT(FoundClosures(hypothesis, {}), IsEmpty());
}

// Tests the words: where the curve is, and what it takes; nothing where it takes nothing that can be seen.
TEST(ClosureSentence, SaysWhatItTakes) {
  std::vector<Closure> closures = FoundClosures(WithFilm(), {});
  closures[0].before = 4;
  closures[0].after = 2;
  closures[0].seconds = 0.4;
  EXPECT_THAT(ClosureSentence(closures),
              AllOf(HasSubstr("a curve of motor_speed in the torque on the pump (it "),
                    HasSubstr("over 0.4 s better: 4 to 2 noise units, 75 % of the squared gap")));
  closures[0].after = 3.9999;
  EXPECT_EQ(ClosureSentence(closures), "");
  closures[0].before = INFINITY;
  EXPECT_THAT(ClosureSentence(closures), HasSubstr("which it cannot without"));
  EXPECT_EQ(ClosureSentence({}), "");
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
