// The pictures of a diagnosis, as data.
#include "diagnose/report/report_pictures.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "diagnose/report/picture_parts.h"
#include "tests/diagnose/example_diagnosis.h"

namespace hydro::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr size_t kSamples = 500;

// Tests that residuals are measured - simulated, in the shown unit, and that there are none without a
// simulation.
TEST(PictureParts, ScalesResiduals) {
  EXPECT_THAT(diagnose::ScaledResiduals({3, 5}, {1, 6}, 2), ElementsAre(4, -2));
  EXPECT_THAT(diagnose::ScaledResiduals({3, 5}, {}, 2), IsEmpty());
}

// Tests labels and noise of channels, those without noise included.
TEST(PictureParts, NamesChannels) {
  EXPECT_EQ(diagnose::LabelOf(model::Channel::kMotorSpeed, "rad/s"), "motor speed (rad/s)");
  EXPECT_EQ(diagnose::NoiseOf(ExampleDiagnosis(kSamples), model::Channel::kP2), 1.62);
  EXPECT_EQ(diagnose::NoiseOf(ExampleDiagnosis(kSamples), model::Channel::kArmAngle), 0);
}

// Tests that the range of residuals holds three noises, and is never larger than what was measured.
TEST(PictureParts, LimitsTheRangeOfResiduals) {
  EXPECT_EQ(diagnose::SizeOf({3, kNan, -2}), 5);
  EXPECT_EQ(diagnose::SizeOf({}), 0);
  const diagnose::Points runs_away{{0, 1}, {1000, -1000}}, quiet{{0, 1}, {0.1, -0.1}};
  const page::Range limited = diagnose::ResidualRange(runs_away, quiet, 20, 1);
  EXPECT_GE(limited.high, 20);
  EXPECT_LE(limited.high, 25);
  EXPECT_EQ(limited.low, -limited.high);
  EXPECT_GE(diagnose::ResidualRange(quiet, quiet, 20, 1).high, 3);
}

// Tests one row for each gap, with the values before, refitted and after on it, and nothing left of the axis.
TEST(GapFigure, HasARowForEachGap) {
  diagnose::Diagnosis diagnosis = ExampleDiagnosis(kSamples);
  diagnosis.fit.after = 0.01;
  const page::Figure figure = diagnose::GapFigure(diagnosis);
  ASSERT_EQ(figure.panels.size(), 1u);
  const page::Panel& panel = figure.panels[0];
  ASSERT_EQ(panel.y.ticks.size(), 5u);  // all held out, all fitted, and three signals
  EXPECT_EQ(panel.y.ticks[2].text, "motor speed, held out");
  ASSERT_EQ(panel.curves.size(), 4u);  // the way, then the three points
  EXPECT_EQ(panel.curves[1].label, "model as given");
  EXPECT_EQ(panel.curves[1].x[0], 23.9);
  EXPECT_EQ(panel.curves[2].x[0], 19.5);
  EXPECT_EQ(panel.curves[3].x[0], 1.06);
  EXPECT_EQ(panel.curves[3].x[1], panel.x.min);
  EXPECT_DOUBLE_EQ(panel.curves[1].x[3], 44.0 / 1.5);  // p1, in noise units
  EXPECT_GT(panel.x.max, 44.0 / 1.5);
}

// Tests that a run has its signals and residuals side by side, with the disagreement shaded where it lies.
TEST(RunFigure, ShowsSignalsAndResiduals) {
  const diagnose::Diagnosis diagnosis = ExampleDiagnosis(kSamples);
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
  EXPECT_FALSE(diagnose::RunFigure(ExampleDiagnosis(kSamples), run, false).has_value());
  run = ExampleDiagnosis(kSamples).curves[0];
  run.time.assign(run.time.size(), 1.0);
  EXPECT_FALSE(diagnose::RunFigure(ExampleDiagnosis(kSamples), run, false).has_value());
}

// Tests a row for each signal and a column for each quantity that was measured.
TEST(DependenceFigure, HasAColumnForEachQuantity) {
  const std::optional<page::Figure> figure = diagnose::DependenceFigure(ExampleDiagnosis(kSamples), false);
  ASSERT_TRUE(figure.has_value());
  ASSERT_EQ(figure->columns, 3u);  // speed, p_2 - p_1, voltage; the arm was not measured
  ASSERT_EQ(figure->panels.size(), 9u);
  EXPECT_EQ(figure->panels[6].x.label, "motor speed (rad/s)");
  EXPECT_EQ(figure->panels[7].x.label, "p_2 - p_1 (psi)");
  EXPECT_EQ(figure->panels[8].x.label, "voltage (V)");
  EXPECT_FALSE(diagnose::DependenceFigure(EmptyDiagnosis(), false).has_value());
}

// Tests that a missing term stands with 95 % bounds, and that the range holds them and zero.
TEST(MissingTermFigure, HasBounds) {
  const diagnose::MissingTerm term{"pump_torque", "in-lbf", "motor_speed", "rad/s", {1, 2}, {5, 7}, {0.5, 1}};
  const page::Figure figure = diagnose::MissingTermFigure(term);
  ASSERT_EQ(figure.panels.size(), 1u);
  const page::Panel& panel = figure.panels[0];
  EXPECT_EQ(panel.y.label, "missing in pump torque (in-lbf)");
  EXPECT_EQ(panel.x.label, "motor speed (rad/s)");
  EXPECT_THAT(panel.curves[0].y_low, ElementsAre(5 - 0.98, 7 - 1.96));
  EXPECT_THAT(panel.curves[0].y_high, ElementsAre(5 + 0.98, 7 + 1.96));
  EXPECT_LE(panel.y.min, 0);
  EXPECT_GE(panel.y.max, 7 + 1.96);
}

}  // namespace
}  // namespace hydro::testing
