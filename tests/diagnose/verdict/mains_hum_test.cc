#include "diagnose/verdict/mains_hum.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/diagnose/small_runs.h"

namespace hydro::diagnose {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

Fitted TrueModel(const std::vector<RunData>& runs) {
  return Fit(testing::WithFree(testing::Table1With(), {}), PointersTo(runs), testing::StartsOf(runs), {});
}

// Tests that hum of a drifting mains frequency on one pressure is named with its signal, and that a clean recording and one that
// lacks an effect are not.
TEST(HumRemarks, OnHumAlone) {
  std::vector<RunData> runs = testing::ClampedPair(testing::Table1With(), 2, 1);
  EXPECT_THAT(HumRemarks(PointersTo(runs), TrueModel(runs)), IsEmpty());
  for (RunData& run : runs) {
    for (SignalData& signal : run.signals) {
      if (signal.channel != model::Channel::kP1) continue;
      for (size_t i = 0; i < signal.values.size(); ++i)
        signal.values[i] += 6 * std::sin(2 * std::numbers::pi * 50.05 * run.stimulus.time[i]);
    }
  }
  const std::vector<std::string> remarks = HumRemarks(PointersTo(runs), TrueModel(runs));
  ASSERT_THAT(remarks, SizeIs(1));
  EXPECT_THAT(remarks[0], HasSubstr("p1: "));
  EXPECT_THAT(remarks[0], HasSubstr("at 50 Hz: mains hum"));

  model::ModelDescription truth = testing::Table1With();
  truth.parameters.b *= 3;
  const std::vector<RunData> lacking = testing::ClampedPair(truth, 2, 1);
  const Fitted wrong = TrueModel(lacking);
  ASSERT_GT(wrong.squared_gap(), 2);
  EXPECT_THAT(HumRemarks(PointersTo(lacking), wrong), IsEmpty());
}

}  // namespace
}  // namespace hydro::diagnose
