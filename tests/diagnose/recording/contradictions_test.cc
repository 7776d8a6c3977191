#include "diagnose/recording/contradictions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "diagnose/recording_first.h"
#include "tests/diagnose/noisy_rig.h"
#include "tests/diagnose/recording/line_in_checklist.h"
#include "tests/diagnose/recording/swing.h"
#include "tests/table1.h"

namespace hydro::diagnose {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::Swing;
using testing::Table1Model;

constexpr double kTurn = 2 * std::numbers::pi;

std::vector<std::string> Found(const runs::MeasuredRun& run) { return Contradictions(Table1Model(), run); }

void Scale(double factor, runs::MeasuredSignal* signal) {
  for (double& value : signal->values) value *= factor;
}

// Tests that a recording that is right says nothing against itself, coarse and with a sensor 20 % too large
// too.
TEST(Contradictions, None) {
  for (const model::Shaft shaft : {model::Shaft::kFree, model::Shaft::kClamped}) {
    for (const bool bypass : {false, true}) EXPECT_THAT(Found(Swing(shaft, bypass)), IsEmpty());
  }
  runs::MeasuredRun run = Swing(model::Shaft::kFree);
  Scale(1.2, &run.arm_speed);
  for (double& angle : run.motor_angle.values) angle = std::round(angle / 0.1) * 0.1;
  EXPECT_THAT(Found(run), IsEmpty());
}

// Tests that an angle that begins again after each turn is named; a single wrong sample is none.
TEST(Contradictions, Turns) {
  runs::MeasuredRun run = Swing(model::Shaft::kFree);
  for (double& angle : run.motor_angle.values) angle -= kTurn * std::floor((angle + 3) / kTurn);
  EXPECT_THAT(Found(run), ElementsAre(HasSubstr("motor_angle jumps by a turn, ")));
  // At 225 rad/s and 1 kHz.
  for (size_t i = 0; i < run.samples(); ++i)
    run.motor_angle.values[i] = std::fmod(0.225 * static_cast<double>(i), kTurn);
  run.motor_speed = {};
  EXPECT_THAT(Found(run), ElementsAre(HasSubstr("motor_angle jumps by a turn, 35 times")));
  run = Swing(model::Shaft::kFree);
  run.motor_angle.values[500] += kTurn;
  EXPECT_THAT(Found(run), IsEmpty());
}

// Tests that times given for a pressure are named, whatever their unit and whether or not they are the
// column of the time; and that a ramp of the command and the angle of an even motion are none.
TEST(Contradictions, Times) {
  runs::MeasuredRun run = Swing(model::Shaft::kClamped);
  run.voltage.values = run.motor_angle.values = run.time;
  run.time_source.column = "t";
  EXPECT_THAT(Found(run), IsEmpty());
  run.p1.values = run.time;
  Scale(14.5, &run.p1);
  EXPECT_THAT(Found(run), ElementsAre("run swing: p1 rises as time does, without noise"));
  run.p1.source.column = "ms";
  EXPECT_THAT(Found(run),
              ElementsAre("run swing: p1 rises as time does, without noise: \"ms\" holds times or "
                          "numbers of rows, so name another column"));
  run.p1.source.column = "t";
  EXPECT_THAT(Found(run), ElementsAre(HasSubstr("p1 is the column of the time: \"t\" holds times")));
  run.p1.values[500] += 1;
  run.p1.source.column = "p";
  EXPECT_THAT(Found(run), IsEmpty());
}

// Tests that temperatures that no oil has are named, with the unit that they may be in.
TEST(Contradictions, Temperatures) {
  runs::MeasuredRun run = Swing(model::Shaft::kClamped);
  for (const double good : {-40.0, 20.0, 120.0}) {
    run.temperature.values.assign(run.samples(), good);
    EXPECT_THAT(Found(run), IsEmpty()) << good;
  }
  for (const double bad : {-400.0, 5000.0}) {
    run.temperature.values.assign(run.samples(), 20);
    run.temperature.values[7] = bad;
    EXPECT_THAT(
        Found(run),
        ElementsAre(AllOf(HasSubstr("run swing: temperature is "),
                          HasSubstr("at 0.007 s, and outside -60 to 200 degC, as no oil is, in 1 sample: "),
                          HasSubstr("a cell damaged?"))))
        << bad;
  }
  run.temperature.values.assign(run.samples(), 293.15);
  EXPECT_THAT(Found(run), ElementsAre(HasSubstr("is its column in K? unit = \"K\"")));
  EXPECT_EQ(testing::LineInChecklist(run, "temperature").substr(0, 4), "look");
  const RecordingReport report = ReportOnRecordings(Table1Model(), {run}, 1);
  EXPECT_THAT(report.wrong, ::testing::Contains(HasSubstr("as no oil is")));
}

// Tests that a bypass that cannot have been open is named.
TEST(Contradictions, Bypass) {
  runs::MeasuredRun run = Swing(model::Shaft::kClamped);
  run.bypass = true;
  EXPECT_THAT(Found(run), ElementsAre(HasSubstr("bypass = false")));
}

// A clamped run of Table 1 with sensors that have noise.
runs::MeasuredRun Recorded(bool bypass, double volts) {
  testing::NoisyRig rig;
  rig.model = {"Table 1", testing::Table1(), {}};
  rig.angle_measured = volts > 1;  // below, the motor does not turn
  return rig
      .Record("run", model::Shaft::kClamped, 0, 1, bypass,
              [volts](double t) { return std::sin(9 * t) > 0 ? volts : -volts; })
      .measured;
}

// Tests that an open bypass that is not stated is named with the line that mends it, and a stated one is not.
TEST(TwinPressures, OpenBypass) {
  runs::MeasuredRun run = Recorded(true, 3);
  EXPECT_THAT(Found(run), IsEmpty());
  run.bypass = false;
  run.sidecar = "rig/byp.toml";
  EXPECT_THAT(Found(run), ElementsAre(HasSubstr("this in byp.toml mends it: bypass = true")));
}

// Tests that pressures that differ, and those of a motor that does not turn, say nothing; and that one column
// for both is named.
TEST(TwinPressures, OthersAndOneColumn) {
  runs::MeasuredRun run = Recorded(false, 3);
  EXPECT_THAT(Found(run), IsEmpty());
  EXPECT_THAT(Found(Recorded(false, 0.2)), IsEmpty());
  run.p2.values = run.p1.values;
  EXPECT_THAT(Found(run), ElementsAre(HasSubstr("the same numbers")));
  run.p2 = {};
  EXPECT_THAT(Found(run), IsEmpty());
}

// Tests that --check calls such a recording wrong, where the model's predictions have nothing against it.
TEST(Contradictions, AreReported) {
  runs::MeasuredRun run = Swing(model::Shaft::kFree);
  for (double& angle : run.motor_angle.values) angle -= kTurn * std::floor((angle + 3) / kTurn);
  const RecordingReport report = ReportOnRecordings(Table1Model(), {run}, 1);
  EXPECT_THAT(report.wrong, ::testing::Contains(HasSubstr("motor_angle jumps by a turn")));
}

}  // namespace
}  // namespace hydro::diagnose
