#include "diagnose/recording/sparse_columns.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "diagnose/recording_first.h"
#include "tests/diagnose/recording/line_in_checklist.h"

namespace hydro::diagnose {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

// A swing of 1000 rows, of whose p1 only some are there.
runs::MeasuredRun WithP1In(const std::function<bool(size_t)>& there) {
  runs::MeasuredRun run = testing::Swing(model::Shaft::kClamped, false);
  for (size_t i = 0; i < run.samples(); ++i) {
    if (!there(i)) run.p1.values[i] = runs::kMissing;
  }
  return run;
}

// Tests that a sensor that has values in few rows by chance, or at one end of the run only, is said, in the
// checklist as well, and makes the recording wrong.
TEST(SparseColumns, UnevenOnes) {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> chance;
  for (const double share : {0.33, 0.2, 0.1, 0.03}) {
    const runs::MeasuredRun run = WithP1In([&](size_t) { return chance(random) < share; });
    EXPECT_THAT(SparseSensorRemarks({run}), ElementsAre(HasSubstr("run swing: p1 is missing in "))) << share;
    EXPECT_THAT(testing::LineInChecklist(run, "p1"), StartsWith("look"));
    EXPECT_THAT(ReportOnRecordings(testing::Table1Model(), {run}, 1).wrong,
                Contains(HasSubstr("p1 is missing in ")));
  }
  EXPECT_THAT(
      SparseSensorRemarks({WithP1In([](size_t i) { return i < 300; })}),
      ElementsAre("run swing: p1 is missing in 70 % of the rows, and not evenly, as of a slower device"));
}

// Tests that the values of a slower sensor are none to remark on: in each fourth row, at a rate that the
// table's is no multiple of, with a few lost, and in a table that joins two devices by their times.
TEST(SparseColumns, SlowerSensors) {
  std::vector<runs::MeasuredRun> slow = {
      WithP1In([](size_t i) { return i % 4 == 0; }), WithP1In([](size_t i) { return i % 25 == 3; }),
      WithP1In([](size_t i) { return i * 10 / 36 != (i + 1) * 10 / 36; }),
      WithP1In([](size_t i) { return i % 5 == 0 && i % 200 != 0; }), WithP1In([](size_t) { return true; })};
  // Between the values of p1, the rows of the other device are now many and now few.
  std::vector<double> time, p1;
  for (int k = 0; k < 250; ++k) {
    for (int other = 0; other < (k % 50 < 25 ? 1 : 6); ++other) {
      time.push_back(0.004 * k + 0.0005 * other);
      p1.push_back(other == 0 ? 100 + k : runs::kMissing);
    }
  }
  EXPECT_EQ(UnevenlyMissing(time, p1, kSlowerSensor), "");
  EXPECT_THAT(SparseSensorRemarks(slow), IsEmpty());
  for (const runs::MeasuredRun& run : slow)
    EXPECT_THAT(testing::LineInChecklist(run, "p1"), Not(HasSubstr("evenly")));
}

// A swing whose command is written in some rows only and held between them.
runs::MeasuredRun WithCommandsIn(const std::function<bool(size_t)>& there) {
  runs::MeasuredRun run = WithP1In([](size_t) { return true; });
  run.written_commands = run.voltage.values;
  for (size_t i = 1; i < run.samples(); ++i) {
    if (there(i)) continue;
    run.written_commands[i] = runs::kMissing;
    run.voltage.values[i] = run.voltage.values[i - 1];
  }
  return run;
}

// Tests that a command that only the first row has, or that was lost now and then, is said and makes the
// recording wrong, that one which is another each time is only said, and that a slower one is neither.
TEST(SparseColumns, Commands) {
  const runs::MeasuredRun once = WithCommandsIn([](size_t) { return false; });
  const std::string says =
      "run swing: voltage is missing in 99.9 % of the rows, and not evenly, as of a slower ";
  EXPECT_THAT(ReportOnRecordings(testing::Table1Model(), {once}, 1).wrong, Contains(StartsWith(says)));
  EXPECT_THAT(
      testing::LineInChecklist(once, "voltage"),
      ::testing::ContainsRegex("^look .*, 999 missing: it never changes; missing in 99.9 % of the rows"));
  std::vector<std::string> lost, changes;
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> chance;
  runs::MeasuredRun some = WithCommandsIn([&](size_t) { return chance(random) < 0.8; });
  AddCommandRemarks({some}, &lost, &changes);
  EXPECT_THAT(lost, IsEmpty());
  EXPECT_THAT(changes, ElementsAre(HasSubstr("is right where the recorder writes changes only")));
  EXPECT_THAT(ReportOnRecordings(testing::Table1Model(), {some}, 1).limits, Contains(changes[0]));
  changes.clear();
  some.written_commands[1] = some.written_commands[0];
  AddCommandRemarks({some}, &lost, &changes);
  EXPECT_THAT(lost, ElementsAre(HasSubstr("each of them holds the command before it")));
  EXPECT_THAT(changes, IsEmpty());
  lost.clear();
  AddCommandRemarks(
      {WithCommandsIn([](size_t i) { return i % 10 == 0; }), WithCommandsIn([](size_t) { return true; }),
       testing::Swing(model::Shaft::kClamped, false)},
      &lost, &changes);
  EXPECT_THAT(lost, IsEmpty());
  EXPECT_THAT(changes, IsEmpty());
}

}  // namespace
}  // namespace hydro::diagnose
