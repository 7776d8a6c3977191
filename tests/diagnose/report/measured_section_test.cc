// Pictures of what the balances measure.
#include "diagnose/report/measured_section.h"

#include <gmock/gmock.h>

namespace hydro::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

diagnose::MeasuredCurve Leakage() {
  return {.element = "cross_leakage",
          .unit = "in^3/s",
          .against = "p2 - p1",
          .against_unit = "psi",
          .at = {-1000, 0, 1000},
          .measured = {-0.02, 0, 0.02},
          .error = {0.001, 0.001, 0.001},
          .model = {-0.01, 0, 0.01},
          .found = {-0.02, 0, 0.02}};
}

// Tests that the picture has both models' curves and the points with 95 % intervals, in the model's units.
TEST(MeasuredFigure, HasModelsAndPoints) {
  const page::Panel panel = diagnose::MeasuredFigure(Leakage(), false).panels.at(0);
  EXPECT_EQ(panel.x.label, "p2 - p1 (psi)");
  EXPECT_EQ(panel.y.label, "cross leakage (in^3/s)");
  ASSERT_EQ(panel.curves.size(), 3u);
  EXPECT_THAT(panel.curves[0].y, ElementsAre(-0.01, 0, 0.01));
  EXPECT_THAT(panel.curves[1].y, ElementsAre(-0.02, 0, 0.02));
  EXPECT_NEAR(panel.curves[2].y_high[2], 0.02 + 1.96e-3, 1e-12);
  EXPECT_NEAR(panel.curves[2].y_low[2], 0.02 - 1.96e-3, 1e-12);
}

// Tests that nothing is drawn twice where nothing was found, and that SI moves values and variable alike.
TEST(MeasuredFigure, WithoutAFindingAndInSi) {
  diagnose::MeasuredCurve leakage = Leakage();
  leakage.found = leakage.model;
  EXPECT_EQ(diagnose::MeasuredFigure(leakage, false).panels.at(0).curves.size(), 2u);
  const page::Panel si = diagnose::MeasuredFigure(Leakage(), true).panels.at(0);
  EXPECT_THAT(si.x.label, ::testing::Not(HasSubstr("psi")));
  EXPECT_NEAR(si.curves[0].y[2] / si.curves[1].y[2], 0.5, 1e-12);
  EXPECT_NE(si.curves[0].x[2], 1000);
}

// Tests that there is no section where no balance could be formed.
TEST(MeasuredSection, OnlyWithCurves) {
  diagnose::Diagnosis diagnosis;
  EXPECT_EQ(diagnose::MeasuredSection(diagnosis, false), "");
  diagnosis.measured = {Leakage()};
  EXPECT_THAT(diagnose::MeasuredSection(diagnosis, false), HasSubstr("cross leakage"));
}

}  // namespace
}  // namespace hydro::testing
