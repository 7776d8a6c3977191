// Pictures of what was found.
#include <gmock/gmock.h>

#include <cmath>

#include "diagnose/report/diagnosis_in_si.h"
#include "diagnose/report/report_pictures.h"
#include "tests/diagnose/example_diagnosis.h"

namespace hydro::testing {
namespace {

using ::testing::ElementsAre;

// Tests that each horizon is a point of each of the three curves, held out and fitted, and ticks are seconds.
TEST(HorizonFigure, HasAPointForEachHorizon) {
  const page::Figure figure = diagnose::HorizonFigure(ExampleDiagnosis(60));
  ASSERT_EQ(figure.panels.size(), 1u);
  const page::Panel& panel = figure.panels[0];
  ASSERT_EQ(panel.curves.size(), 6u);
  EXPECT_THAT(panel.curves[0].x, ElementsAre(0.1, 0.4, 1.6));
  EXPECT_THAT(panel.curves[0].y, ElementsAre(6, 12, 19));      // held out, as given
  EXPECT_THAT(panel.curves[5].y, ElementsAre(1, 1.01, 1.02));  // fitted, with what was found
  EXPECT_EQ(panel.x.ticks[1].text, "0.4");
  EXPECT_LT(panel.y.min, 1);
  EXPECT_GT(panel.y.max, 19);
}

// Tests that a term's picture has the curve of the effect and the points that are lacking without it, over its
// own variable.
TEST(FoundTermFigure, HasTheCurveAndThePoints) {
  const diagnose::Diagnosis diagnosis = ExampleDiagnosis(60);
  ASSERT_EQ(diagnosis.terms.size(), 1u);
  const page::Panel panel = diagnose::FoundTermFigure(diagnosis.terms[0]).panels[0];
  EXPECT_EQ(panel.x.label, "motor speed (rad/s)");
  EXPECT_EQ(panel.y.label, "pump torque (in-lbf)");
  ASSERT_EQ(panel.curves.size(), 2u);
  EXPECT_EQ(panel.curves[0].y, diagnosis.terms[0].value);
  EXPECT_EQ(panel.curves[1].y, diagnosis.terms[0].missing.mean);
  EXPECT_EQ(panel.curves[1].stroke, page::Stroke::kPoints);
}

// Tests that the curve of a term moves to SI with its points.
TEST(FoundTermFigure, InSi) {
  const diagnose::Diagnosis own = ExampleDiagnosis(60), si = diagnose::InSi(own);
  const diagnose::FoundTerm &before = own.terms[0], &after = si.terms[0];
  EXPECT_EQ(after.missing.unit, "N m");
  EXPECT_DOUBLE_EQ(after.value[3] / before.value[3], after.missing.mean[3] / before.missing.mean[3]);
  EXPECT_EQ(after.at, before.at) << "rad/s stays";
}

// Tests that a stretch shows the measurement, and the model with the effect and without it, in the shown unit.
TEST(StretchFigure, ShowsTheModelWithAndWithout) {
  const diagnose::Diagnosis diagnosis = ExampleDiagnosis(60);
  ASSERT_EQ(diagnosis.stretches.size(), 1u);
  const page::Panel panel = diagnose::StretchFigure(diagnosis.stretches[0], {}, false).panels[0];
  ASSERT_EQ(panel.curves.size(), 3u);
  EXPECT_EQ(panel.y.label, "p1 (psi)");
  EXPECT_THAT(panel.curves[1].y, ElementsAre(100, 200, 300));
  EXPECT_THAT(panel.curves[2].y, ElementsAre(100, 150, 250));
  const page::Panel si = diagnose::StretchFigure(diagnosis.stretches[0], {}, true).panels[0];
  EXPECT_EQ(si.y.label, "p1 (kPa)");
  EXPECT_NEAR(si.curves[1].y[0], 689.5, 0.1);
}

}  // namespace
}  // namespace hydro::testing
