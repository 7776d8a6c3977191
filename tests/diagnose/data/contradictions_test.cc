#include "diagnose/data/contradictions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/units.h"
#include "diagnose/recording_first.h"
#include "tests/diagnose/data/swing.h"

namespace hydro::diagnose {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::Swing;
using testing::Table1Model;

constexpr double kTurn = 2 * std::numbers::pi;

std::vector<std::string> Found(const runs::MeasuredRun& run) {
  std::vector<std::string> texts;
  for (const Contradiction& one : Contradictions(Table1Model(), run)) texts.push_back(one.text);
  return texts;
}

void Scale(double factor, runs::MeasuredSignal* signal) {
  for (double& value : signal->values) value *= factor;
}

// Tests that a recording that is right says nothing against itself, coarse and with a sensor 20 % too large too.
TEST(Contradictions, None) {
  for (const model::Shaft shaft : {model::Shaft::kFree, model::Shaft::kClamped}) {
    for (const bool bypass : {false, true}) EXPECT_THAT(Found(Swing(shaft, bypass)), IsEmpty());
  }
  runs::MeasuredRun run = Swing(model::Shaft::kFree);
  Scale(1.2, &run.arm_speed);
  for (double& angle : run.motor_angle.values) angle = std::round(angle / 0.1) * 0.1;
  EXPECT_THAT(Found(run), IsEmpty());
}

// Tests that a speed that is not the rate of its angle is named with the units that it looks like, or its sign.
TEST(Contradictions, Rates) {
  runs::MeasuredRun run = Swing(model::Shaft::kFree);
  Scale(Degrees(1), &run.arm_speed);
  EXPECT_THAT(
      Found(run),
      ElementsAre(HasSubstr("arm_speed is 57.2 times the rate of arm_angle, as degrees are to radians")));
  run = Swing(model::Shaft::kFree);
  Scale(1 / kTurn, &run.motor_angle);
  EXPECT_THAT(
      Found(run),
      ElementsAre(HasSubstr("motor_speed is 6.28 times the rate of motor_angle, as radians are to turns")));
  run = Swing(model::Shaft::kFree);
  Scale(-1, &run.arm_angle);
  const std::vector<Contradiction> turned = Contradictions(Table1Model(), run);
  ASSERT_EQ(turned.size(), 1u);
  EXPECT_TRUE(turned[0].only_sign);
  EXPECT_THAT(turned[0].text, HasSubstr("arm_speed falls where arm_angle rises"));
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

// Tests that a bypass that cannot have been open is named.
TEST(Contradictions, Bypass) {
  runs::MeasuredRun run = Swing(model::Shaft::kClamped);
  run.bypass = true;
  EXPECT_THAT(Found(run), ElementsAre(HasSubstr("bypass = false")));
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
