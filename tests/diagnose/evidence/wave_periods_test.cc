// Tests that the periods of what repeats with the shaft are found.
#include "diagnose/evidence/wave_periods.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <numbers>
#include <utility>

#include "tests/diagnose/evidence/scanned.h"

namespace hydro::testing {
namespace {

std::vector<int> PeriodsOf(const Scanned& scanned, int jobs) {
  return diagnose::LikelyPeriods(scanned.runs, scanned.rows, diagnose::SetEvidence(scanned.rows), jobs);
}

// Tests that the periods of cogging are among the few that are likely, the same on one job and on two.
TEST(WavePeriods, OfCogging) {
  for (const double periods : {7.0, 12.0}) {
    const model::EffectDescription cogging = {
        "motor.cogging", {{"amplitude", 2}, {"periods", periods}, {"phase", 0.4}}, {}};
    const Scanned scanned(ClampedPair(Table1With({cogging}), 2, 21), {"motor.cogging"});
    const std::vector<int> likely = PeriodsOf(scanned, 1);
    EXPECT_THAT(likely, ::testing::Contains(static_cast<int>(periods)));
    EXPECT_LE(likely.size(), 2u);
    EXPECT_TRUE(std::is_sorted(likely.begin(), likely.end()));
    EXPECT_EQ(PeriodsOf(scanned, 2), likely);
  }
}

// Tests that a pump with nine pistons is found by its flow, among what cogging could be.
TEST(WavePeriods, OfTheFlow) {
  const model::EffectDescription ripple = {"pump.flow_ripple", {{"amplitude", 0.05}, {"periods", 9}}, {}};
  const Scanned scanned(ClampedPair(Table1With({ripple}), 2, 22), {"motor.cogging", "pump.flow_ripple"});
  EXPECT_THAT(PeriodsOf(scanned, 1), ::testing::Contains(9));
}

// Tests that what is slower than what was seen to repeat is no faster wave: of a shaft that turns by less
// than a turn, two periods a turn are no wave of four or five.
TEST(WavePeriods, NoneOfWhatIsSlower) {
  const model::EffectDescription slow = {
      "motor.cogging", {{"amplitude", 3}, {"periods", 2}, {"phase", 0.4}}, {}};
  std::vector<diagnose::RunData> runs;
  for (const int which : {0, 1}) {
    NoisyRig rig;
    rig.model = Table1With({slow});
    rig.seed = 31 + static_cast<uint64_t>(which);
    runs.push_back(rig.Record("short", model::Shaft::kClamped, 0, 2, true, [which](double t) {
      return (2.6 + 0.2 * which) * std::sin(2 * std::numbers::pi * 3 * t);
    }));
  }
  const Scanned scanned(std::move(runs), {"motor.cogging"});
  const int fewest = diagnose::FewestPeriods(scanned.runs.motions());
  ASSERT_GT(fewest, 2);
  ASSERT_LT(fewest, 10);
  EXPECT_THAT(PeriodsOf(scanned, 1), ::testing::IsEmpty());
}

// Tests that there are none where no effect that may be missing repeats with the shaft.
TEST(WavePeriods, NoneWithoutSuchEffects) {
  const Scanned scanned(ClampedPair(Table1With(), 0.5, 23), {"amp.lag"});
  EXPECT_THAT(PeriodsOf(scanned, 1), ::testing::IsEmpty());
}

// Tests that a shaft that turns by a third of a turn shows two periods of what repeats six times a turn, and
// none of five.
TEST(WavePeriods, SeenToRepeat) {
  std::vector<diagnose::RunMotion> runs(2);
  EXPECT_GT(diagnose::FewestPeriods(runs), diagnose::kMostPeriods);
  for (const double angle : {0.5, 0.5 + 2.1, 1.0}) {
    model::KnownMotion at;
    at.motor_angle = angle;
    runs[1].at.push_back(at);
  }
  EXPECT_EQ(diagnose::FewestPeriods(runs), 6);
  for (model::KnownMotion& at : runs[1].at) at.motor_angle *= 0.1;  // less than two of kMostPeriods
  EXPECT_GT(diagnose::FewestPeriods(runs), diagnose::kMostPeriods);
}

}  // namespace
}  // namespace hydro::testing
