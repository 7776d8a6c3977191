// The trials among which the next experiment is chosen.
#include "diagnose/say/trials.h"

#include <gmock/gmock.h>

#include <cmath>
#include <set>

#include "tests/diagnose/small_runs.h"

namespace hydro::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

// Tests that the rig's limits are the largest values of all runs, and its noise the smallest.
TEST(Inspect, TakesTheLargestOfAllRuns) {
  std::vector<diagnose::RunData> runs = ClampedPair(Table1With(), 0.3, 1);
  runs.push_back(SmallRun(Table1With(), model::Shaft::kFree, false, 0.3, 2, 1));
  const diagnose::Rig rig = diagnose::Inspect(PointersTo(runs));
  double voltage = 0, speed = 0;
  for (const diagnose::RunData& run : runs) {
    for (const double v : run.stimulus.voltage) voltage = std::max(voltage, std::abs(v));
    for (const double s : run.Find(model::Channel::kMotorSpeed)->values) speed = std::max(speed, std::abs(s));
  }
  EXPECT_EQ(rig.voltage, voltage);
  EXPECT_EQ(rig.speed, speed);
  EXPECT_TRUE(rig.free);
  EXPECT_LE(rig.low_angle, 0.1);   // the second run's clamp; the free arm begins at -0.1
  EXPECT_GE(rig.high_angle, 0.3);  // the first run's clamp
  const size_t p1 = static_cast<size_t>(model::Channel::kP1);
  for (const diagnose::RunData& run : runs) EXPECT_LE(rig.noise[p1], run.Find(model::Channel::kP1)->noise);
}

diagnose::Rig SmallRig() {
  diagnose::Rig rig;
  rig.voltage = 6;
  rig.pressure = 512.5;
  rig.low_angle = rig.high_angle = 0.1;
  return rig;
}

// Tests that no trial exceeds the voltage that the rig has seen, that each stimulus is what its trial says,
// and that a clamped arm is tried at other angles within the stroke, and free only if it was free.
TEST(Trials, StayWithinTheRig) {
  const std::vector<diagnose::Trial> trials = diagnose::Trials(SmallRig(), Table1());
  ASSERT_FALSE(trials.empty());
  std::set<double> angles;
  double largest = 0;
  for (const diagnose::Trial& trial : trials) {
    EXPECT_EQ(trial.shaft, model::Shaft::kClamped);
    angles.insert(trial.arm_angle);
    largest = std::max({largest, trial.voltage->Max(), -trial.voltage->Min()});
  }
  EXPECT_NEAR(largest, 6, 1e-9);
  EXPECT_EQ(angles.size(), 3u);
  EXPECT_LT(*angles.rbegin(), 0.8 * Table1().V_ms / Table1().c + 1e-3);
  const model::Stimulus stimulus = diagnose::StimulusOf(trials.front());
  ASSERT_EQ(stimulus.time.size(), 3000u);
  EXPECT_EQ(stimulus.time[1], 1e-3);
  EXPECT_EQ(stimulus.voltage[1234], trials.front().voltage->Value(stimulus.time[1234]));

  diagnose::Rig free = SmallRig();
  free.free = true;
  EXPECT_GT(diagnose::Trials(free, Table1()).size(), trials.size());
}

// Tests how a trial is written: numbers without needless digits, and limits above what the rig has seen.
TEST(Trials, AreWrittenAsConfigurations) {
  const std::vector<diagnose::Trial> trials = diagnose::Trials(SmallRig(), Table1());
  const std::string text = diagnose::Configuration(trials.front(), SmallRig());
  EXPECT_THAT(text, HasSubstr("shaft = \"clamped\"\n"));
  EXPECT_THAT(text, HasSubstr("duration_s = 3\n"));
  EXPECT_THAT(text, HasSubstr("rate_hz = 1000\n"));
  EXPECT_THAT(text, HasSubstr("kind = \"square\"\noffset = 0\namplitude = 2.4\nfrequency_hz = 0.7\n"));
  EXPECT_THAT(text, HasSubstr("pressure = 615\n"));
  diagnose::Rig unknown = SmallRig();
  unknown.pressure = 0;
  EXPECT_THAT(diagnose::Configuration(trials.front(), unknown), Not(HasSubstr("[limits]")));
}

}  // namespace
}  // namespace hydro::testing
