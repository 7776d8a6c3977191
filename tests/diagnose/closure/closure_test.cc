// The closure of a gap that no known effect explains: of a rig with friction that none of the catalogue's has the form of.
#include "diagnose/closure/closure.h"

#include <gmock/gmock.h>

#include <cmath>

#include "diagnose/closure/curve_start.h"
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

constexpr double kFilm = 0.4;  // in-lbf at 10 rad/s

// Friction as the root of speed, as a curve with many knots: the rig's own form, which the gap finder does not know.
model::ModelDescription Filmed() {
  model::EffectDescription film;
  film.id = "closure.pump_torque";
  film.name_lists["against"] = {"motor_speed"};
  for (int k = -40; k <= 40; ++k) {
    const double speed = k * std::abs(k) * 0.125;
    film.lists["knots"].push_back(speed);
    film.lists["values"].push_back(-std::copysign(kFilm * std::sqrt(std::abs(speed) / 10), speed));
  }
  return testing::Table1With({film});
}

struct Rigs {
  std::vector<RunData> fitted, held_out;
  SearchContext context;
};

// Clamped runs to fit, of a rig of this model, and one to hold out.
Rigs RigsOf(const model::ModelDescription& truth, int fitted = 2) {
  Rigs rigs;
  for (int which = 0; which < fitted; ++which) {
    rigs.fitted.push_back(testing::SmallRun(truth, model::Shaft::kClamped, false, 3, which, 7));
  }
  rigs.held_out.push_back(testing::SmallRun(truth, model::Shaft::kClamped, false, 3, 5, 7));
  rigs.context.given = testing::Table1With();
  rigs.context.runs = PointersTo(rigs.fitted);
  rigs.context.held_out = PointersTo(rigs.held_out);
  return rigs;
}

Explanation AsGiven(const model::ModelDescription& model) {
  Explanation given;
  given.fitted.hypothesis.model = model;
  return given;
}

ClosedModel ClosedOf(const Rigs& rigs) {
  const Explanation given = AsGiven(rigs.context.given);
  const Localisation located = Locate(rigs.context.given, rigs.context.runs);
  return FindClosure(rigs.context, {&given, false}, located.possible);
}

// Tests that a closure takes most of the held-out gap, says what it resembles, and that its model is written, read back bit
// by bit and simulated.
TEST(Closure, TakesMostOfTheGap) {
  const ClosedModel closed = ClosedOf(RigsOf(Filmed()));
  ASSERT_THAT(closed.closures, SizeIs(1));
  const Closure& closure = closed.closures[0];
  EXPECT_EQ(closure.id, "closure.pump_torque");
  EXPECT_THAT(closure.against, ElementsAre("motor_speed"));
  EXPECT_EQ(closure.unit, "in-lbf");
  EXPECT_THAT(closure.against_units, ElementsAre("rad/s"));
  EXPECT_GT(closure.before, 3);
  EXPECT_LT(std::pow(closure.after / closure.before, 2), 0.3);
  EXPECT_THAT(closure.resembles, HasSubstr("square root of |motor_speed|"))
      << ::testing::PrintToString(closure.knots[0]) << ::testing::PrintToString(closure.value)
      << ::testing::PrintToString(closure.low) << ::testing::PrintToString(closure.high);
  EXPECT_THAT(closure.resembles, HasSubstr("against it"));
  ASSERT_EQ(closure.low.size(), closure.value.size());
  for (size_t i = 0; i < closure.value.size(); ++i) EXPECT_LT(closure.low[i], closure.high[i]);
  EXPECT_THAT(ClosureSentence(closed.closures),
              HasSubstr("a curve of motor_speed in the torque on the pump"));

  const model::ModelDescription back =
      settings::ParseModel(settings::FormatModel(closed.model), "model.toml");
  EXPECT_EQ(back.effects.at(0).lists, closed.model.effects.at(0).lists);
  model::Actuator actuator(back, {.shaft = model::Shaft::kClamped});
  actuator.Advance(3, 0.1);
  EXPECT_TRUE(std::isfinite(actuator.Measure().p2));
}

// Tests that the same inputs give the same bits, whatever the number of threads is.
TEST(Closure, DoesNotDependOnJobs) {
  Rigs rigs = RigsOf(Filmed());
  const ClosedModel one = ClosedOf(rigs);
  rigs.context.jobs = 2;
  const ClosedModel two = ClosedOf(rigs);
  ASSERT_THAT(one.closures, SizeIs(1));
  ASSERT_THAT(two.closures, SizeIs(1));
  EXPECT_EQ(one.closures[0].value, two.closures[0].value);
  EXPECT_EQ(one.closures[0].after, two.closures[0].after);
}

// Tests that where runs are held out in turn, every other one is fitted and the rest judges.
TEST(Closure, InTurn) {
  Rigs rigs = RigsOf(Filmed(), 4);
  rigs.context.held_out.clear();
  const ClosedModel closed = ClosedOf(rigs);
  ASSERT_THAT(closed.closures, SizeIs(1));
  EXPECT_EQ(closed.closures[0].id, "closure.pump_torque");
}

// Tests that nothing is added where nothing is missing, nor a second time.
TEST(Closure, NotWhereNothingIsMissing) {
  EXPECT_THAT(ClosedOf(RigsOf(testing::Table1With())).closures, IsEmpty());
  const Rigs rigs = RigsOf(Filmed());
  Localisation located = Locate(rigs.context.given, rigs.context.runs);
  std::erase_if(located.possible,
                [](const PossibleTerm& term) { return term.table.balance != "pump_torque"; });
  ASSERT_THAT(located.possible, ::testing::Not(IsEmpty()));
  const Explanation has = AsGiven(Filmed());
  EXPECT_THAT(FindClosure(rigs.context, {&has, false}, located.possible).closures, IsEmpty());
}

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
