// Sections with tables and curves.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "diagnose/report/diagnosis_in_si.h"
#include "diagnose/report/page_sections.h"
#include "tests/diagnose/example_diagnosis.h"

namespace hydro::diagnose {
namespace {

using ::testing::HasSubstr;

ValueByRun Friction() {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  ValueByRun friction;
  friction.name = "T_s";
  friction.unit = "in-lbf";
  friction.values = {{"monday", 2, 1.9, 2.1, "in-lbf"},
                     {"tuesday", 3, 2.9, 3.1, "in-lbf"},
                     {"stuck", kNan, kNan, kNan, "in-lbf"}};
  friction.before = 4;
  friction.after = 1.5;
  return friction;
}

// Tests a row for each run, one that cannot be simulated too, and nothing where no value differs.
TEST(PerRunSection, ARowForEachRun) {
  Diagnosis diagnosis = testing::ExampleDiagnosis();
  diagnosis.per_run.clear();
  EXPECT_EQ(PerRunSection(diagnosis), "");
  diagnosis.per_run = {Friction()};
  const std::string section = PerRunSection(diagnosis);
  EXPECT_THAT(section,
              HasSubstr("<td>tuesday</td><td class=\"number\">3</td><td class=\"number\">2.9 to 3.1</td>"));
  EXPECT_THAT(section, HasSubstr("cannot be simulated"));
  EXPECT_THAT(section, HasSubstr("gap of 1.5 instead of 4 noise units"));
}

// Tests that --si converts the values of all runs alike.
TEST(PerRunSection, InSi) {
  Diagnosis diagnosis = testing::ExampleDiagnosis();
  diagnosis.per_run = {Friction()};
  const ValueByRun si = InSi(diagnosis).per_run.front();
  EXPECT_EQ(si.unit, "N m");
  EXPECT_NEAR(si.values[0].value / 2, 0.112985, 1e-6);
  EXPECT_NEAR(si.values[1].high / 3.1, 0.112985, 1e-6);
  EXPECT_EQ(si.values[1].unit, "N m");
  EXPECT_EQ(si.before, 4);
}

// Tests that there is no section where no balance could be formed.
TEST(MeasuredSection, OnlyWithCurves) {
  Diagnosis diagnosis;
  EXPECT_EQ(MeasuredSection(diagnosis), "");
  diagnosis.measured = {{.element = "cross_leakage", .at = {-1, 1}, .measured = {-2, 2}, .error = {1, 1}}};
  EXPECT_THAT(MeasuredSection(diagnosis), HasSubstr("cross leakage"));
}

}  // namespace
}  // namespace hydro::diagnose
