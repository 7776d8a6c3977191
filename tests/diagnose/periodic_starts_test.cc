// Effects that repeat within a turn are read off the balances before anything is fitted.
#include "diagnose/search/periodic_starts.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "tests/diagnose/small_runs.h"

namespace hydro::testing {
namespace {

const std::vector<diagnose::Change> kPeriodic = {{"motor.cogging", {}, ""}, {"pump.flow_ripple", {}, ""}};

// The likeliest start of an effect; null where there is none.
const model::EffectDescription* Likeliest(const std::vector<diagnose::Hypothesis>& starts,
                                          const std::string& id) {
  for (const diagnose::Hypothesis& start : starts) {
    if (start.changes.back().effect == id) return &start.model.effects.back();
  }
  return nullptr;
}

std::vector<diagnose::Hypothesis> StartsFor(const model::ModelDescription& truth,
                                            const std::vector<diagnose::Change>& changes, int jobs) {
  const std::vector<diagnose::RunData> runs = OneOfEach(truth, 1.0, 1);
  return diagnose::WithPeriodic(WithFree(Table1With(), {}), changes, PointersTo(runs), jobs);
}

// Tests that a strong cogging is read with its number of periods, its phase and its order of magnitude; the
// fit does most of the rest, since smoothing makes a disturbance smaller than it is.
TEST(WithPeriodic, ReadsCogging) {
  for (const int periods : {5, 6, 11}) {
    const model::ModelDescription truth =
        Table1With({{"motor.cogging",
                     {{"amplitude", 1}, {"periods", static_cast<double>(periods)}, {"phase", 0.7}},
                     {}}});
    const std::vector<diagnose::Hypothesis> starts = StartsFor(truth, kPeriodic, 1);
    const model::EffectDescription* cogging = Likeliest(starts, "motor.cogging");
    ASSERT_NE(cogging, nullptr) << periods;
    EXPECT_EQ(cogging->parameters.at("periods"), periods);
    EXPECT_LT(std::abs(std::remainder(cogging->parameters.at("phase") - 0.7, 2 * std::numbers::pi)), 0.4)
        << periods;
    EXPECT_GT(cogging->parameters.at("amplitude"), 0.25);
    EXPECT_LT(cogging->parameters.at("amplitude"), 1.2);
  }
}

// Tests the same for a displacement that varies. Its sign is half a period, which is in the angle of each run's shaft.
TEST(WithPeriodic, ReadsAFlowRipple) {
  for (const double amplitude : {0.1, -0.1}) {
    const std::vector<diagnose::Hypothesis> starts = StartsFor(
        Table1With({{"pump.flow_ripple", {{"amplitude", amplitude}, {"periods", 9}}, {}}}), kPeriodic, 1);
    const model::EffectDescription* ripple = Likeliest(starts, "pump.flow_ripple");
    ASSERT_NE(ripple, nullptr);
    EXPECT_EQ(ripple->parameters.at("periods"), 9);
    EXPECT_NEAR(ripple->parameters.at("amplitude"), std::abs(amplitude), 0.07);
  }
}

// Tests that missing samples are left out, and that a run without pressures does not count.
TEST(WithPeriodic, LeavesOutWhatIsMissing) {
  const model::ModelDescription truth =
      Table1With({{"motor.cogging", {{"amplitude", 1}, {"periods", 6}, {"phase", 0.7}}, {}}});
  std::vector<diagnose::RunData> runs = ClampedPair(truth, 1.0, 1);
  runs::MeasuredRun gaps = runs[0].measured, bare = runs[1].measured;
  for (size_t i = 0; i + 1 < gaps.samples(); i += 3) {
    gaps.motor_speed.values[i] = gaps.p2.values[i + 1] = std::numeric_limits<double>::quiet_NaN();
  }
  bare.p1 = bare.p2 = {};
  runs.clear();
  runs.push_back(diagnose::PrepareRun(gaps, Table1()));
  runs.push_back(diagnose::PrepareRun(bare, Table1()));
  const std::vector<diagnose::Hypothesis> starts =
      diagnose::WithPeriodic(WithFree(Table1With(), {}), {kPeriodic[0]}, PointersTo(runs), 1);
  const model::EffectDescription* cogging = Likeliest(starts, "motor.cogging");
  ASSERT_NE(cogging, nullptr);
  EXPECT_EQ(cogging->parameters.at("periods"), 6);
}

// Tests that nothing is proposed that may not be named, or where nothing repeats.
TEST(WithPeriodic, OnlyWhatIsAskedForAndThere) {
  const model::ModelDescription truth =
      Table1With({{"motor.cogging", {{"amplitude", 1}, {"periods", 6}, {"phase", 0}}, {}}});
  EXPECT_THAT(StartsFor(truth, {{"pump.stribeck", {}, ""}}, 1), ::testing::IsEmpty());
  EXPECT_EQ(Likeliest(StartsFor(truth, {kPeriodic[1]}, 1), "motor.cogging"), nullptr);
  EXPECT_THAT(StartsFor(Table1With(), kPeriodic, 1), ::testing::IsEmpty());
}

// Tests that the bits do not depend on the number of threads.
TEST(WithPeriodic, SameForAnyNumberOfThreads) {
  const model::ModelDescription truth =
      Table1With({{"motor.cogging", {{"amplitude", 1}, {"periods", 6}, {"phase", 0.7}}, {}}});
  const std::vector<diagnose::Hypothesis> a = StartsFor(truth, kPeriodic, 1),
                                          b = StartsFor(truth, kPeriodic, 2);
  ASSERT_EQ(a.size(), b.size());
  for (size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].model.effects.back().parameters, b[i].model.effects.back().parameters);
  }
}

}  // namespace
}  // namespace hydro::testing
