// The pictures of a diagnosis, as data.
#include "diagnose/report/report_pictures.h"

#include <gmock/gmock.h>

#include "diagnose/report/diagnosis_in_si.h"
#include "tests/diagnose/example_diagnosis.h"

namespace hydro::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr size_t kPictured = 500;

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
TEST(CurveFigure, HasModelsAndPoints) {
  const page::Panel panel = diagnose::CurveFigure(Leakage()).panels.at(0);
  EXPECT_EQ(panel.x.label, "p2 - p1 (psi)");
  EXPECT_EQ(panel.y.label, "cross leakage (in^3/s)");
  ASSERT_EQ(panel.curves.size(), 3u);
  EXPECT_THAT(panel.curves[0].y, ElementsAre(-0.01, 0, 0.01));
  EXPECT_THAT(panel.curves[1].y, ElementsAre(-0.02, 0, 0.02));
  EXPECT_NEAR(panel.curves[2].y_high[2], 0.02 + 1.96e-3, 1e-12);
  EXPECT_NEAR(panel.curves[2].y_low[2], 0.02 - 1.96e-3, 1e-12);
}

// Tests that nothing is drawn twice where nothing was found, and that SI moves values and variable alike.
TEST(CurveFigure, WithoutAFindingAndInSi) {
  diagnose::MeasuredCurve leakage = Leakage();
  leakage.found = leakage.model;
  EXPECT_EQ(diagnose::CurveFigure(leakage).panels.at(0).curves.size(), 2u);
  diagnose::Diagnosis diagnosis;
  diagnosis.measured = {Leakage()};
  const page::Panel si = diagnose::CurveFigure(diagnose::InSi(diagnosis).measured[0]).panels.at(0);
  EXPECT_THAT(si.x.label, ::testing::Not(HasSubstr("psi")));
  EXPECT_NEAR(si.curves[0].y[2] / si.curves[1].y[2], 0.5, 1e-12);
  EXPECT_NE(si.curves[0].x[2], 1000);
}

// Tests that a missing term stands with 95 % bounds, and that the range holds them and zero.
TEST(CurveFigure, HasBoundsOfWhatIsMissing) {
  const diagnose::MeasuredCurve term{"",      "pump_torque", "in-lbf", "motor_speed",
                                     "rad/s", {1, 2},        {5, 7},   {0.5, 1}};
  const page::Figure figure = diagnose::CurveFigure(term);
  ASSERT_EQ(figure.panels.size(), 1u);
  const page::Panel& panel = figure.panels[0];
  EXPECT_EQ(panel.y.label, "missing in pump torque (in-lbf)");
  EXPECT_EQ(panel.x.label, "motor speed (rad/s)");
  EXPECT_THAT(panel.curves[0].y_low, ElementsAre(5 - 0.98, 7 - 1.96));
  EXPECT_THAT(panel.curves[0].y_high, ElementsAre(5 + 0.98, 7 + 1.96));
  EXPECT_LE(panel.y.min, 0);
  EXPECT_GE(panel.y.max, 7 + 1.96);
}

// Tests that an interval that few samples leave wide does not make the picture flat.
TEST(CurveFigure, IsAsHighAsItsCurves) {
  diagnose::MeasuredCurve leakage = Leakage();
  leakage.error[2] = 5;
  const page::Panel panel = diagnose::CurveFigure(leakage).panels.at(0);
  EXPECT_LT(panel.y.max, 0.1);
  EXPECT_GT(panel.curves[2].y_high[2], 9);
}

// Tests that a term's picture has the curve of the effect and the points that are lacking without it, over
// its own variable.
TEST(TermFigure, HasTheCurveAndThePoints) {
  const diagnose::Diagnosis diagnosis = ExampleDiagnosis(60);
  ASSERT_EQ(diagnosis.terms.size(), 1u);
  const page::Panel panel = diagnose::CurveFigure(diagnosis.terms[0]).panels[0];
  EXPECT_EQ(panel.x.label, "motor speed (rad/s)");
  EXPECT_EQ(panel.y.label, "pump torque (in-lbf)");
  ASSERT_EQ(panel.curves.size(), 2u);
  EXPECT_EQ(panel.curves[0].y, diagnosis.terms[0].found);
  EXPECT_EQ(panel.curves[1].y, diagnosis.terms[0].measured);
  EXPECT_EQ(panel.curves[1].stroke, page::Stroke::kPoints);
}

// Tests that the curve of a term moves to SI with its points.
TEST(TermFigure, InSi) {
  const diagnose::Diagnosis own = ExampleDiagnosis(60), si = diagnose::InSi(own);
  const diagnose::MeasuredCurve &before = own.terms[0], &after = si.terms[0];
  EXPECT_EQ(after.unit, "N m");
  EXPECT_DOUBLE_EQ(after.found[3] / before.found[3], after.measured[3] / before.measured[3]);
  EXPECT_EQ(after.at, before.at) << "rad/s stays";
}

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

// Tests that a run has its signals and residuals side by side, with the disagreement shaded where it lies.
TEST(RunFigure, ShowsSignalsAndResiduals) {
  const diagnose::Diagnosis diagnosis = ExampleDiagnosis(kPictured);
  const std::optional<page::Figure> figure = diagnose::RunFigure(diagnosis, diagnosis.curves[0], false);
  ASSERT_TRUE(figure.has_value());
  EXPECT_EQ(figure->columns, 2u);
  ASSERT_EQ(figure->panels.size(), 6u);
  const page::Panel &signal = figure->panels[2], &residual = figure->panels[3];
  EXPECT_EQ(signal.y.label, "p1 (psi)");
  ASSERT_EQ(signal.bands.size(), 2u);  // of this run; the third window is the other run's
  EXPECT_EQ(signal.bands[0].from, 1.4);
  EXPECT_EQ(residual.bands.back().to, 2 * 1.5);  // twice the noise
  EXPECT_EQ(residual.curves[0].y[0],
            diagnosis.curves[0].curves[1].measured[0] - diagnosis.curves[0].curves[1].before[0]);
  const double shown = diagnose::RunFigure(diagnosis, diagnosis.curves[0], true)->panels[2].curves[0].y[0];
  EXPECT_NEAR(shown / signal.curves[0].y[0], 6.894757, 1e-6);  // kPa
}

// Tests that nothing is drawn of a run without curves or without time.
TEST(RunFigure, NoneWithoutCurves) {
  diagnose::RunCurves run;
  run.time = {0, 1};
  EXPECT_FALSE(diagnose::RunFigure(ExampleDiagnosis(kPictured), run, false).has_value());
  run = ExampleDiagnosis(kPictured).curves[0];
  run.time.assign(run.time.size(), 1.0);
  EXPECT_FALSE(diagnose::RunFigure(ExampleDiagnosis(kPictured), run, false).has_value());
}

// Tests that what ran away does not make the picture of a run flat, and that residuals keep room for three
// times the noise.
TEST(RunFigure, LimitsItsRanges) {
  diagnose::Diagnosis diagnosis = ExampleDiagnosis(kPictured);
  diagnosis.curves[0].curves[1].before.assign(kPictured, 1e9);
  diagnosis.curves[0].curves[1].after = diagnosis.curves[0].curves[1].measured;
  const std::optional<page::Figure> figure = diagnose::RunFigure(diagnosis, diagnosis.curves[0], false);
  EXPECT_LT(figure->panels[2].y.max, 2500);
  EXPECT_LT(figure->panels[3].y.max, 1000);
  EXPECT_GE(figure->panels[5].y.max, 3 * 1.62);
}

// Tests that a stretch shows the measurement, and the model with the effect and without it, in the shown
// unit.
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
