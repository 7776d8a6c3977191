// Diagnoses in SI units.
#include "diagnose/report/diagnosis_in_si.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/diagnose/example_diagnosis.h"

namespace hydro::testing {
namespace {

constexpr double kPascalPerPsi = 6894.757293168361;
constexpr double kNewtonMetrePerInchPound = 0.1129848290276167;

// Tests that pressures are shown in kPa, and what is SI already as it is.
TEST(UnitOf, IsSiOnRequest) {
  const diagnose::ShownUnit paper = diagnose::UnitOf(model::Channel::kP1, {}, false);
  EXPECT_EQ(paper.unit, "psi");
  EXPECT_EQ(paper.factor, 1);
  const diagnose::ShownUnit si = diagnose::UnitOf(model::Channel::kP1, {}, true);
  EXPECT_EQ(si.unit, "kPa");
  EXPECT_NEAR(si.factor, kPascalPerPsi / 1000, 1e-9);
  EXPECT_EQ(diagnose::UnitOf(model::Channel::kMotorSpeed, {}, true).unit, "rad/s");
  EXPECT_EQ(diagnose::UnitOf(model::Channel::kMotorSpeed, {}, true).factor, 1);
}

// Tests the units of models in other systems, as they are and in the same SI units.
TEST(UnitOf, IsTheModels) {
  EXPECT_EQ(diagnose::UnitOf(model::Channel::kP1, kSiUnits, false).unit, "Pa");
  EXPECT_EQ(diagnose::UnitOf(model::Channel::kP1, kSiUnits, false).factor, 1);
  EXPECT_EQ(diagnose::UnitOf(model::Channel::kP1, kSiUnits, true).unit, "kPa");
  EXPECT_DOUBLE_EQ(diagnose::UnitOf(model::Channel::kP1, kSiUnits, true).factor, 1e-3);
  const UnitSystem cylinder{"in", "lbf", true};
  EXPECT_EQ(diagnose::UnitOf(model::Channel::kArmSpeed, cylinder, false).unit, "in/s");
  EXPECT_EQ(diagnose::UnitOf(model::Channel::kArmAngle, cylinder, true).unit, "m");
  EXPECT_EQ(diagnose::UnitOf(model::Channel::kMotorSpeed, cylinder, false).unit, "rad/s");
}

// Tests that a value, its interval and the model's value are converted alike, and missing terms with their
// errors.
TEST(InSi, ConvertsParametersAndTerms) {
  const diagnose::Diagnosis paper = ExampleDiagnosis(100);
  const diagnose::Diagnosis si = diagnose::InSi(paper);
  const diagnose::ChangedParameter &b = paper.parameters[0], &converted = si.parameters[0];
  ASSERT_EQ(b.fitted.unit, "in-lbf-s");
  const double factor = converted.fitted.value / b.fitted.value;
  EXPECT_NE(converted.fitted.unit, b.fitted.unit);
  EXPECT_DOUBLE_EQ(converted.fitted.low, factor * b.fitted.low);
  EXPECT_DOUBLE_EQ(converted.fitted.high, factor * b.fitted.high);
  EXPECT_DOUBLE_EQ(converted.model, factor * b.model);

  const diagnose::MeasuredCurve &term = paper.missing[0], &shown = si.missing[0];
  ASSERT_EQ(term.unit, "in-lbf");
  const double torque = shown.measured[0] / term.measured[0];
  // N m, or mN m for small ones.
  const double ratio = torque / kNewtonMetrePerInchPound;
  EXPECT_TRUE(std::abs(ratio - 1) < 1e-9 || std::abs(ratio - 1000) < 1e-6) << shown.unit << " " << ratio;
  EXPECT_DOUBLE_EQ(shown.error[0], torque * term.error[0]);
  EXPECT_EQ(shown.at, term.at);  // rad/s
}

// Tests that the place of the disagreement is converted: single values, ranges and signs, and no names.
TEST(InSi, ConvertsWhere) {
  const auto converted = [](const std::string& where) {
    diagnose::Diagnosis paper = ExampleDiagnosis(100);
    paper.location[0].where = where;
    return diagnose::InSi(paper).location[0].where;
  };
  EXPECT_EQ(converted("p2 - p1 from -100 to 300 psi"), "p2 - p1 from -0.689 to 2.07 MPa");
  EXPECT_EQ(converted("where the valves hold p_3, p1 reads +3.1 psi and p2 -20 psi against the model"),
            "where the valves hold p_3, p1 reads +21.4 kPa and p2 -138 kPa against the model");
  for (const char* same : {"|motor_speed| < 5 rad/s, at reversals", "|voltage| > 2.5 V",
                           "changes with the sign of p1 - 3 sides", "the same everywhere", ""})
    EXPECT_EQ(converted(same), same);
}

// Tests that signals and sentences stay as they are.
TEST(InSi, LeavesSignalsAndSentences) {
  const diagnose::Diagnosis paper = ExampleDiagnosis(100);
  const diagnose::Diagnosis si = diagnose::InSi(paper);
  EXPECT_EQ(si.sentence, paper.sentence);
  EXPECT_EQ(si.signals[1].noise, paper.signals[1].noise);
  EXPECT_EQ(si.curves[0].curves[1].before, paper.curves[0].curves[1].before);
}

}  // namespace
}  // namespace hydro::testing
