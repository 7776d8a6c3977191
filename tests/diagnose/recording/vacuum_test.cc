#include "diagnose/recording/vacuum.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "diagnose/evidence/checklist.h"
#include "tests/diagnose/recording/line_in_checklist.h"

namespace hydro::diagnose {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::LineInChecklist;
using ::testing::StartsWith;
using testing::Table1Model;

runs::MeasuredRun Swing() { return testing::Swing(model::Shaft::kFree, false); }

// Tests that readings down to a vacuum are pressures, and lower ones are not: one sample of noise, and a
// sensor whose zero is low.
TEST(Vacuum, FindsWhatNoFluidHas) {
  runs::MeasuredRun run = Swing();
  EXPECT_FALSE(FindBelowVacuum(Table1Model(), run.p1));
  run.p1.values[5] = -14.6;
  EXPECT_FALSE(FindBelowVacuum(Table1Model(), run.p1));
  run.p1.values[7] = -20;
  const auto brief = FindBelowVacuum(Table1Model(), run.p1);
  ASSERT_TRUE(brief);
  EXPECT_EQ(brief->samples, 1U);
  EXPECT_EQ(brief->lowest, -20);
  EXPECT_NEAR(brief->zero, -14.6959, 1e-9);
  EXPECT_FALSE(brief->lasting);
  for (double& value : run.p2.values) value -= 150;  // p_3 is 100 psi
  const auto lasting = FindBelowVacuum(Table1Model(), run.p2);
  ASSERT_TRUE(lasting);
  EXPECT_TRUE(lasting->lasting);
  EXPECT_GT(lasting->samples, 15U);
}

// Tests that the checklist shows such a signal as one to look at, in the units that it shows, and any other
// as good.
TEST(Vacuum, IsInTheChecklist) {
  runs::MeasuredRun run = Swing();
  run.p1.values[7] = -20;
  EXPECT_THAT(LineInChecklist(run, "p1"),
              AllOf(StartsWith("look "), HasSubstr("; 1 sample is below -14.7 psi, a vacuum, "
                                                   "down to -20 psi: noise")));
  EXPECT_THAT(
      LineInChecklist(run, "p1", true),
      ::testing::ContainsRegex("below (-0.1013 M|-101.3 k)Pa, a vacuum, down to (-0.1379 M|-137.9 k)Pa"));
  EXPECT_THAT(LineInChecklist(run, "p2"), StartsWith("ok "));
}

// Tests that the remarks, which every use of the gap finder makes, have one line for each pressure, with the
// runs that show it, and that noise is told from a zero that is low.
TEST(Vacuum, HasARemark) {
  runs::MeasuredRun good = Swing(), noisy = Swing(), low = Swing();
  good.name = "good";
  noisy.name = "noisy";
  low.name = "low";
  noisy.p1.values[7] = -20;
  for (double& value : low.p2.values) value -= 150;
  std::vector<std::string> lasting, brief;
  AddVacuumRemarks(Table1Model(), {good}, &lasting, &brief);
  EXPECT_THAT(lasting, IsEmpty());
  EXPECT_THAT(brief, IsEmpty());
  AddVacuumRemarks(Table1Model(), {good, noisy, low}, &lasting, &brief);
  ASSERT_EQ(brief.size(), 1U);
  EXPECT_THAT(brief[0],
              AllOf(StartsWith("run noisy: p1: 1 sample is below -14.7 psi"), HasSubstr("noise, or")));
  ASSERT_EQ(lasting.size(), 1U);
  EXPECT_THAT(lasting[0], AllOf(StartsWith("run low: p2: "), HasSubstr("a sensor whose zero is low?")));
}

}  // namespace
}  // namespace hydro::diagnose
