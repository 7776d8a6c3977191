#include "launch/logic/run_summary.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace hydro::launch {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

loop_statistics_t Report(double interval_s, int64_t cycles, double p50_us, double latency_max_us) {
  loop_statistics_t report{};
  report.session = 1;
  report.role = "plant";
  report.interval_s = interval_s;
  report.cycles = cycles;
  report.period_p50_us = p50_us;
  report.latency_max_us = latency_max_us;
  report.missed_deadlines = 2;
  report.lost_messages = 1;
  return report;
}

// Tests that hearing nothing prints nothing.
TEST(RunSummaryTest, EmptyWithoutReports) { EXPECT_THAT(RunSummary().Lines(), IsEmpty()); }

// Tests that a status has what the last report says, with a fault that lasts, and fits a terminal of 80
// columns.
TEST(RunSummaryTest, Status) {
  RunSummary summary;
  EXPECT_THAT(summary.Status(), IsEmpty());
  loop_statistics_t report = Report(2, 1996, 1001, 345);
  report.latency_p99_us = 87.6;
  summary.Add(report);
  ASSERT_EQ(summary.Status().size(), 1u);
  EXPECT_EQ(StatusLine(summary.Status()[0]),
            "plant            998 Hz  p99     88 us  missed    2  lost   1  ok");
  fault_t fault{};
  fault.session = 1;
  fault.code = "second_pressure_command_sender";
  fault.active = true;
  summary.Add(fault);
  const std::string line = StatusLine(summary.Status()[0]);
  EXPECT_THAT(line, HasSubstr("  second_pressur"));
  EXPECT_LE(line.size(), 79u);
  fault.active = false;
  summary.Add(fault);
  EXPECT_THAT(StatusLine(summary.Status()[0]), HasSubstr("  ok"));
}

// Tests that counts add up over the run, and that percentiles are those of the last report of a whole second.
TEST(RunSummaryTest, CountsAddUpPercentilesAreTheLast) {
  RunSummary summary;
  summary.Add(Report(1.0, 1000, 1001, 345));
  summary.Add(Report(1.0, 1000, 1003, 40));
  summary.Add(Report(0.01, 10, 77777, 20));  // the rest of the run
  const auto lines = summary.Lines();
  ASSERT_EQ(lines.size(), 3u);
  EXPECT_THAT(lines[2], AllOf(HasSubstr("plant"), HasSubstr(" 2010 "), HasSubstr(" 1003 "),
                              HasSubstr(" 345 "), HasSubstr(" 6 "), Not(HasSubstr("77777"))));
  EXPECT_EQ(lines[2].substr(lines[2].size() - 2), " 3");
  EXPECT_EQ(lines[1].size(), lines[2].size());
}

// Tests that the table fits a terminal of 80 columns beside the longest label, whatever the numbers are, and
// that its columns stay apart.
TEST(RunSummaryTest, TheTableFits) {
  constexpr size_t kBesideTheLabel = 79 - std::string_view("[position_ctrl] ").size();
  RunSummary summary;
  loop_statistics_t report = Report(1.0, 1000, 1001, 345);
  report.role = "position_ctrl";
  summary.Add(report);
  report = Report(90000, 18000000000, 123456, 9.87e9);
  report.session = 2;
  report.period_p99_us = report.latency_p50_us = report.latency_p99_us = 1234567;
  report.missed_deadlines = report.lost_messages = INT64_MAX;
  summary.Add(report);
  const auto lines = summary.Lines();
  ASSERT_EQ(lines.size(), 4u);
  for (const std::string& line : lines) EXPECT_LE(line.size(), kBesideTheLabel) << line;
  EXPECT_EQ(lines[2], "position_ctrl   1000  1001     0     0     0    345      2    1");
  EXPECT_EQ(lines[3], "plant         18000M  123k 1235k 1235k 1235k  9870M  9223P   9E");
}

// Tests that a plant that slept through a part of its ticks gets advice, with the numbers, and that a loop or
// a few ticks do not.
TEST(RunSummaryTest, SkippedTicks) {
  RunSummary summary;
  loop_statistics_t report = Report(3.0, 1583, 1001, 345);
  report.missed_deadlines = 1417;
  report.role = "pressure_ctrl";
  summary.Add(report);
  EXPECT_EQ(summary.SkippedTicksAdvice("rig.toml"), "");
  report.role = "driver";
  report.session = 2;
  summary.Add(report);
  EXPECT_THAT(
      summary.SkippedTicksAdvice("rig.toml"),
      AllOf(HasSubstr("driver: 1417 of 3000 ticks (47 %) were skipped"),
            HasSubstr("hydro-launch doctor rig.toml"), HasSubstr("with a simulated plant, --time lockstep")));
  RunSummary good;
  report.missed_deadlines = 9;
  good.Add(report);
  EXPECT_EQ(good.SkippedTicksAdvice("rig.toml"), "");
}

// Tests that a report over the whole run replaces the sums.
TEST(RunSummaryTest, WholeRunReplacesTheSum) {
  RunSummary summary;
  summary.Add(Report(1.0, 1000, 1001, 345));
  loop_statistics_t total = Report(1.3, 1300, 1002, 400);
  total.whole_run = true;
  summary.Add(total);
  EXPECT_THAT(summary.Lines()[2], AllOf(HasSubstr(" 1300 "), HasSubstr(" 1002 "), HasSubstr(" 400 ")));
}

// Tests that a run too short for a whole second still shows what it has.
TEST(RunSummaryTest, ShortRunShowsItsOnlyReport) {
  RunSummary summary;
  summary.Add(Report(0.2, 200, 1002, 30));
  EXPECT_THAT(summary.Lines().back(), HasSubstr(" 1002 "));
}

// Tests that the last line says what the output holds, and a refused zero clearly.
TEST(RunSummaryTest, OutputLeft) {
  RunSummary summary;
  summary.Add(Report(0.2, 200, 1002, 30));
  output_left_t left{};
  left.role = "driver";
  left.accepted = 1;
  left.voltage = 3.05e-4;
  summary.Add(left);
  EXPECT_EQ(summary.Lines().back(), "driver: the output reads back 0.000305 V");
  left.accepted = 0;
  left.voltage = std::nan("");
  summary.Add(left);
  EXPECT_EQ(summary.Lines().back(), "driver: the output did NOT accept zero volts and cannot be read back");
}

// Tests that repeated faults share one line with their number, and that an ended fault differs from an active
// one.
TEST(RunSummaryTest, FaultsAreCounted) {
  fault_t fault{};
  fault.session = 1;
  fault.source = "pressure_ctrl";
  fault.code = "stale_state";
  fault.text = "no state for 120 ms, allowed are 100 ms";
  RunSummary summary;
  for (const bool active : {true, false, true, false}) {
    fault.active = active;
    summary.Add(fault);
  }
  fault.code = "pressure_limit";
  fault.active = true;
  summary.Add(fault);
  fault.text = "another cause";
  summary.Add(fault);
  const auto lines = summary.Lines();
  ASSERT_EQ(lines.size(), 2u);
  EXPECT_EQ(lines[0], "fault stale_state of pressure_ctrl, 2 times: no state for 120 ms, allowed are 100 ms");
  EXPECT_THAT(lines[1],
              HasSubstr("pressure_limit of pressure_ctrl, 2 times, still there at the end: another cause"));
  EXPECT_THAT(summary.FaultsLeft(), testing::ElementsAre("pressure_limit of pressure_ctrl"));
  EXPECT_EQ(FaultsLeftText(summary.FaultsLeft()),
            "the run ended with active faults: pressure_limit of pressure_ctrl");
  EXPECT_EQ(FaultsLeftText({}), "");
  fault.session = 2;  // another stack's pressure loop, say
  summary.Add(fault);
  fault.code = "logger_gone";  // a warning
  summary.Add(fault);
  EXPECT_EQ(summary.FaultsLeft().size(), 1u);
}

fault_t ActiveFault(int64_t session, const char* code, const char* source) {
  fault_t fault{};
  fault.session = session;
  fault.code = code;
  fault.source = source;
  fault.active = 1;
  return fault;
}

// Tests that a fault of another stack is left out, and that the same fault of this stack is not.
TEST(RunSummaryTest, FaultsOfAnotherStack) {
  RunSummary summary;
  fault_t fault = ActiveFault(7, "other_stack", "plant");
  summary.Add(fault);
  const auto is_foreign = [](int64_t session) { return session == 7; };
  EXPECT_THAT(summary.FaultsLeft(is_foreign), IsEmpty());
  fault.session = 8;
  summary.Add(fault);
  EXPECT_THAT(summary.FaultsLeft(is_foreign), testing::ElementsAre("other_stack of plant"));
}

// Tests that a limit that the plant and the pressure loop of a joint both see passed is listed once, with
// what became of it in each, and that another joint's has a line of its own.
TEST(RunSummaryTest, AFaultThatTwoSeeIsListedOnce) {
  RunSummary summary;
  const auto add = [&](const char* source, bool active, const char* text) {
    fault_t fault{};
    fault.code = "pressure_limit";
    fault.source = source;
    fault.active = active ? 1 : 0;
    fault.text = text;
    summary.Add(fault);
  };
  add("knee pressure_ctrl", true, "tick 43: p2 is 110.3 psi");
  add("hip plant", true, "tick 44: p1 is 111 psi");
  add("knee plant", true, "tick 43: p2 is 110.3 psi");
  add("knee pressure_ctrl", false, "tick 43: p2 is 110.3 psi");
  add("knee pressure_ctrl", true, "tick 52: p1 is 110.9 psi");
  EXPECT_THAT(summary.Lines(), ::testing::ElementsAre(
                                   "fault pressure_limit of knee pressure_ctrl, 2 times, still there at the "
                                   "end, and of knee plant, once, still there at the end: tick 43: p2 is "
                                   "110.3 psi",
                                   "fault pressure_limit of hip plant, once, still there at the end: tick "
                                   "44: p1 is 111 psi"));
  EXPECT_EQ(summary.FaultsLeft().size(), 3U);
}

// Tests that a fault whose sender's name changed on the way ends with that sender's own report of its end,
// and is no fault that stays; and that joints without sessions are told apart by their names.
TEST(RunSummaryTest, ASenderIsItsSession) {
  RunSummary summary;
  fault_t fault = ActiveFault(7, "stale_state", "pr%ssure_ctrl");
  summary.Add(fault);
  fault.source = "pressure_ctrl";
  fault.active = 0;
  summary.Add(fault);
  EXPECT_THAT(summary.FaultsLeft(), IsEmpty());
  fault.session = 0;
  fault.active = 1;
  fault.source = "hip plant";
  summary.Add(fault);
  fault.source = "knee plant";
  summary.Add(fault);
  fault.active = 0;
  summary.Add(fault);
  EXPECT_THAT(summary.FaultsLeft(), ::testing::ElementsAre("stale_state of hip plant"));
}

// Tests that no fault is without words, whatever its message lacks: forged, or of a program of the user's
// own.
TEST(RunSummaryTest, NoFaultWithoutWords) {
  RunSummary summary;
  fault_t fault{};
  fault.active = true;
  summary.Add(fault);
  fault.session = 2;
  fault.source = "driver";
  fault.code = "device_fault";
  fault.text = " \t\n";
  summary.Add(fault);
  EXPECT_THAT(
      summary.Lines(),
      testing::ElementsAre(
          "fault without a name of an unnamed process, once, still there at the end: no reason is given",
          "fault device_fault of driver, once, still there at the end: no reason is given"));
  EXPECT_EQ(summary.FaultsLeft().front(), "a fault without a name of an unnamed process");
}

}  // namespace
}  // namespace hydro::launch
