// Closures in report.json and report.html.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <regex>

#include "diagnose/report/diagnosis_in_si.h"
#include "diagnose/report/page_sections.h"
#include "diagnose/report/report.h"
#include "tests/diagnose/example_diagnosis.h"

namespace hydro::diagnose {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using Json = nlohmann::json;

Closure Curve() {
  return {.id = "closure.pump_torque",
          .unit = "in-lbf",
          .against = {"motor_speed"},
          .against_units = {"rad/s"},
          .knots = {{-100, 0, 100}},
          .value = {2, 0, -2},
          .low = {1.9, -0.1, -2.1},
          .high = {2.1, 0.1, -1.9},
          .before = 9,
          .after = 3,
          .seconds = 0.4,
          .resembles = "is proportional to motor_speed, against it"};
}

Closure Surface() {
  return {.id = "closure.flow_1",
          .unit = "in^3/s",
          .against = {"arm_angle", "p2 - p1"},
          .against_units = {"rad", "psi"},
          .knots = {{-0.2, 0.2}, {-500, 0, 500}},
          .value = {1, 0, -1, 2, 0, -2},
          .low = {0, -1, -2, 1, -1, -3},
          .high = {2, 1, 0, 3, 1, -1},
          .before = 9,
          .after = 3,
          .seconds = 0.4,
          .resembles = "is proportional to p2 - p1, by a factor that depends on arm_angle"};
}

Json JsonOf(const Diagnosis& diagnosis) { return Json::parse(ReportJson(diagnosis, "", 1)); }

// Tests the keys of a closure, of a surface its rows, and null without any.
TEST(ClosureReport, InJson) {
  Diagnosis diagnosis = testing::ExampleDiagnosis();
  EXPECT_TRUE(JsonOf(diagnosis).at("closure").is_null());
  diagnosis.closures = {Curve(), Surface()};
  const Json closure = JsonOf(diagnosis).at("closure");
  EXPECT_EQ(closure["id"], "closure.pump_torque");
  EXPECT_EQ(closure["against"], Json({"motor_speed"}));
  EXPECT_EQ(closure["at"], Json({-100.0, 0.0, 100.0}));
  EXPECT_EQ(closure["value"], Json({2.0, 0.0, -2.0}));
  EXPECT_EQ(closure["ci95"][2], Json({-2.1, -1.9}));
  EXPECT_EQ(closure["held_out"], Json({{"before", 9.0}, {"after", 3.0}}));
  EXPECT_EQ(closure["seconds"], 0.4);
  EXPECT_EQ(closure["resembles"], "is proportional to motor_speed, against it");
  ASSERT_EQ(closure["also"].size(), 1u);
  const Json surface = closure["also"][0];
  EXPECT_EQ(surface["at"][1], Json({-500.0, 0.0, 500.0}));
  EXPECT_EQ(surface["value"][1], Json({2.0, 0.0, -2.0}));
  EXPECT_EQ(surface["ci95"][0][2], Json({-2.0, 0.0}));
}

// Tests that the page shows the curve, the cuts of a surface, and the gap before and after.
TEST(ClosureReport, OnThePage) {
  Diagnosis diagnosis = testing::ExampleDiagnosis();
  EXPECT_THAT(ReportHtml(diagnosis, false), Not(HasSubstr("What no known effect explains")));
  diagnosis.closures = {Curve(), Surface()};
  const std::string page = ReportHtml(diagnosis, false);
  EXPECT_THAT(page, HasSubstr("<h2>What no known effect explains</h2>"));
  EXPECT_THAT(page,
              HasSubstr("<h3>An unknown curve over motor speed in pump torque [closure.pump_torque]</h3>"));
  EXPECT_THAT(page, HasSubstr("with 3 noise units instead of 9: it takes 89 % of the squared gap"));
}

// Tests that the picture is as high as the curve needs, and not as its band at a knot that few samples reach.
TEST(ClosureReport, PictureOfTheCurve) {
  Diagnosis diagnosis = testing::ExampleDiagnosis();
  diagnosis.closures = {Curve()};
  diagnosis.closures[0].high.back() = 1000;
  const std::string section = ClosureSection(diagnosis);
  const std::string picture =
      section.substr(section.find("<svg"), section.rfind("</svg>") - section.find("<svg"));
  EXPECT_THAT(picture, HasSubstr(">2</text>"));
  EXPECT_FALSE(std::regex_search(picture, std::regex("text-anchor=\"end\"[^>]*>[0-9]{3}"))) << picture;
}

// Tests that --si converts values, bands, knots and units.
TEST(ClosureReport, InSi) {
  Diagnosis diagnosis = testing::ExampleDiagnosis();
  diagnosis.closures = {Curve(), Surface()};
  const Diagnosis si = diagnose::InSi(diagnosis);
  const Closure& curve = si.closures[0];
  EXPECT_EQ(curve.unit, "N m");
  EXPECT_NEAR(curve.value[0] / 2, 0.112985, 1e-6);
  EXPECT_NEAR(curve.low[0] / 1.9, 0.112985, 1e-6);
  EXPECT_EQ(curve.knots[0][0], -100);
  EXPECT_NE(si.closures[1].against_units[1], "psi");
  EXPECT_NE(si.closures[1].knots[1][0], -500);
}

}  // namespace
}  // namespace hydro::diagnose
