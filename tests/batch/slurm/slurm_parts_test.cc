#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/word_list.h"
#include "batch/slurm/array_folder.h"
#include "batch/slurm/grouping.h"
#include "batch/slurm/slurm_answers.h"
#include "batch/slurm/slurm_cluster.h"

namespace hydro::batch {
namespace {

using std::chrono::seconds;
using ::testing::DoubleNear;
using ::testing::ElementsAre;
using ::testing::Optional;

bool Never() { return false; }

// Tests what is read of `scontrol show config`, and that Slurm's own defaults hold for what it does not say.
TEST(SlurmAnswersTest, Limits) {
  const ClusterLimits standard =
      ParseLimits("MaxArraySize            = 1001\nSchedulerParameters     = (null)\n");
  EXPECT_EQ(standard.array_jobs, 1001);
  EXPECT_EQ(standard.all_jobs, 10000);
  EXPECT_DOUBLE_EQ(standard.start_s, 3.1);
  const ClusterLimits other = ParseLimits(
      "Configuration data as of 2026-01-01\nMaxArraySize = 40001\nMaxJobCount = 200000\n"
      "SchedulerParameters = bf_interval=30,batch_sched_delay=10,defer\n");
  EXPECT_EQ(other.array_jobs, 40001);
  EXPECT_EQ(other.all_jobs, 200000);
  EXPECT_DOUBLE_EQ(other.start_s, 10.1);
  // Slurm looks once a second at most, whatever is set.
  EXPECT_DOUBLE_EQ(ParseLimits("SchedulerParameters = batch_sched_delay=0").start_s, 1.1);
  EXPECT_EQ(ParseLimits("").array_jobs, 1001);
}

// Tests that what sbatch refuses comes with the option that helps, and that nothing is made up for other
// words.
TEST(SlurmAnswersTest, WaysOut) {
  EXPECT_THAT(
      WayOut("sbatch: error: QOSMaxSubmitJobPerUserLimit\nsbatch: error: Batch job submission failed: Job "
             "violates "
             "accounting/QOS policy (job submit limit, user's size and/or time limits)"),
      ::testing::AllOf(::testing::HasSubstr("--cases-per-job"), ::testing::HasSubstr("--sbatch=--qos=NAME"),
                       ::testing::HasSubstr("sacctmgr show qos")));
  EXPECT_THAT(WayOut("Batch job submission failed: Invalid qos specification"),
              ::testing::HasSubstr("--sbatch=--qos=NAME"));
  EXPECT_THAT(WayOut("error: invalid partition specified: nowhere"), ::testing::HasSubstr("--partition"));
  EXPECT_THAT(WayOut("Requested time limit is invalid (missing or exceeds some limit)"),
              ::testing::HasSubstr("--time-limit"));
  EXPECT_EQ(WayOut("Socket timed out on send/recv operation"), "");
}

// Tests the id that sbatch prints, alone, with a cluster's name, after other lines, or not at all.
TEST(SlurmAnswersTest, Submitted) {
  EXPECT_THAT(ParseSubmitted("1234\n"), Optional(1234));
  EXPECT_THAT(ParseSubmitted("1234;alps\n"), Optional(1234));
  EXPECT_THAT(ParseSubmitted("a site's greeting\n77\n"), Optional(77));
  EXPECT_EQ(ParseSubmitted(""), std::nullopt);
  EXPECT_EQ(ParseSubmitted("Submitted\n"), std::nullopt);
  EXPECT_EQ(ParseSubmitted("0\n"), std::nullopt);
}

// Tests that the jobs of each array are counted, and that the reason is not the limit that was asked for
// while there is another.
TEST(SlurmAnswersTest, Queue) {
  const auto arrays = ParseQueue(
      "12|PENDING|JobArrayTaskLimit|hydro-a\n12|PENDING|Priority|hydro-a\n12|RUNNING|None|hydro-a\n"
      "9|COMPLETING|None|hydro-b\nnonsense\n|||\n12|COMPLETING|None|hydro-a\n");
  ASSERT_EQ(arrays.size(), 2u);
  EXPECT_EQ(arrays[0].id, 9);
  EXPECT_EQ(arrays[0].running, 1);
  EXPECT_EQ(arrays[1].name, "hydro-a");
  EXPECT_EQ(arrays[1].running, 2);
  EXPECT_EQ(arrays[1].pending, 2);
  EXPECT_FALSE(arrays[1].held);
  EXPECT_TRUE(ParseQueue("5|PENDING|JobHeldUser|hydro-c\n").at(0).held);
  EXPECT_EQ(arrays[1].reason, "Priority");
}

// Tests the forms of sbatch --time.
TEST(SlurmAnswersTest, TimeLimits) {
  EXPECT_THAT(ParseTimeLimit("30"), Optional(1800.0));
  EXPECT_THAT(ParseTimeLimit("2:30"), Optional(150.0));
  EXPECT_THAT(ParseTimeLimit("1:00:01"), Optional(3601.0));
  EXPECT_THAT(ParseTimeLimit("2-12"), Optional(60 * 3600.0));
  EXPECT_THAT(ParseTimeLimit("0-1:30"), Optional(5400.0));
  EXPECT_THAT(ParseTimeLimit("1-0:0:5"), Optional(86405.0));
  for (const char* wrong : {"", "soon", "1h", "1:2:3:4", "-3", "1:-2", "x-1"})
    EXPECT_EQ(ParseTimeLimit(wrong), std::nullopt) << wrong;
}

// Tests that starting a job costs at most a twentieth of it, with a job for each case where a case is long.
TEST(GroupingTest, StartsCostLittle) {
  for (const double case_s : {0.001, 0.3, 1.0, 7.0, 100.0}) {
    const Grouping grouping = ChooseGrouping({.missing = 1'000'000, .case_s = case_s, .start_s = 3.1});
    EXPECT_GE(static_cast<double>(grouping.cases) * case_s, 20 * 3.1) << case_s;
    EXPECT_GE(grouping.cases * grouping.jobs, 1'000'000);
    EXPECT_LT(grouping.cases * (grouping.jobs - 1), 1'000'000);
  }
  EXPECT_EQ(ChooseGrouping({.missing = 500, .case_s = 100, .start_s = 3.1}).jobs, 500);
  // 101 cases are one job of 101, not one of 62 and one of 39.
  EXPECT_EQ(ChooseGrouping({.missing = 101, .case_s = 1, .start_s = 3.1}).jobs, 1);
  EXPECT_EQ(ChooseGrouping({.missing = 5, .case_s = 0.001, .start_s = 3.1}).cases, 5);
  EXPECT_EQ(ChooseGrouping({.missing = 5, .case_s = 0, .start_s = 3.1}).cases, 5);
}

// Tests that jobs end together where it is known how many run at once, and that a job of many processors has
// more cases.
TEST(GroupingTest, FillsProcessors) {
  EXPECT_EQ(ChooseGrouping({.missing = 240, .case_s = 1, .start_s = 1.1, .at_once = 4}).jobs, 8);
  EXPECT_EQ(ChooseGrouping({.missing = 240, .case_s = 1, .start_s = 1.1, .at_once = 100}).jobs, 10);
  EXPECT_EQ(ChooseGrouping({.missing = 240, .case_s = 1, .start_s = 1.1}).jobs, 10);
  EXPECT_EQ(ChooseGrouping({.missing = 240, .case_s = 1, .start_s = 1.1, .processors = 4}).jobs, 2);
}

// Tests the processors that work, of the standard partition or another: not those of nodes that are down.
TEST(SlurmAnswersTest, Processors) {
  const std::string text = "short|0/8/0/8\nall*|4/2/16/22\nall*|0/1/0/1\nodd|x\n";
  EXPECT_EQ(ParseProcessors(text, ""), 7);
  EXPECT_EQ(ParseProcessors(text, "all"), 7);
  EXPECT_EQ(ParseProcessors(text, "short"), 8);
  EXPECT_EQ(ParseProcessors(text, "other"), 0);
}

// Tests that jobs take at most half of their time limit, though not less than a case, and that a wish is
// obeyed.
TEST(GroupingTest, LimitsAndWishes) {
  EXPECT_EQ(ChooseGrouping({.missing = 1000, .case_s = 1, .start_s = 3.1, .limit_s = 60}).cases, 30);
  EXPECT_EQ(ChooseGrouping({.missing = 101, .case_s = 1, .start_s = 3.1, .limit_s = 140}).jobs, 2);
  EXPECT_EQ(ChooseGrouping({.missing = 1000, .case_s = 50, .start_s = 3.1, .limit_s = 60}).cases, 1);
  const Grouping wished =
      ChooseGrouping({.missing = 10, .case_s = 1, .start_s = 3.1, .limit_s = 60, .cases_wished = 4});
  EXPECT_EQ(wished.cases, 4);
  EXPECT_EQ(wished.jobs, 3);
}

// Tests that a text of any characters reaches a program as it is.
TEST(ArrayScriptTest, WordsForTheShell) {
  for (const std::string text : {"plain", "it's", "a b", "\"$HOME\" `x` \\", "", "'", "new\nline", "%A*?"}) {
    const Answer answer = AskCommand({"/bin/sh", "-c", "printf %s " + ShellWord(text)}, seconds(20), Never);
    EXPECT_EQ(answer.out, text);
  }
  EXPECT_EQ(PlainName("it's 100 % of_a.study-1"), "it_s_100___of_a.study-1");
  EXPECT_EQ(PlainName(std::string(100, 'x')).size(), 40u);
}

// Tests that what the user passes on comes after what may be changed, and before what may not.
TEST(SlurmClusterTest, OrderOfArguments) {
  EXPECT_THAT(
      SbatchArguments({.name = "n",
                       .script = "/a b/script",
                       .folder = "/a b",
                       .jobs = 8,
                       .at_once = 3,
                       .arguments = {"--no-requeue", "--mem=1G"}}),
      ElementsAre("sbatch", "--parsable", "--requeue", "--output=/dev/null", "--job-name=n", "--chdir=/a b",
                  "--no-requeue", "--mem=1G", "--hold", "--array=0-7%3", "/a b/script"));
}

// Tests what a command prints and returns, that a late one is ended, and one that is to stop.
TEST(AnsweredCommandTest, Answers) {
  const Answer good = AskCommand({"/bin/sh", "-c", "echo out; echo err >&2; exit 3"}, seconds(20), Never);
  EXPECT_TRUE(good.ended_itself);
  EXPECT_EQ(good.exit_code, 3);
  EXPECT_EQ(good.out, "out\n");
  EXPECT_EQ(good.err, "err\n");
  EXPECT_FALSE(AskCommand({"/bin/sleep", "100"}, seconds(0), Never).ended_itself);
  EXPECT_FALSE(AskCommand({"/bin/sleep", "100"}, seconds(50), [] { return true; }).ended_itself);
}

// Tests when a job ran, by its log: the last beginning counts, and one without an end is none.
TEST(ArrayFolderTest, SpansOfJobs) {
  const auto span = ParseJobSpan("begin 100.5 n1 7 0\nbegin 200.5 n2 7 1\n4 cases\nend 210.25 0\n");
  ASSERT_TRUE(span);
  EXPECT_DOUBLE_EQ(span->began, 200.5);
  EXPECT_DOUBLE_EQ(span->ended, 210.25);
  EXPECT_FALSE(ParseJobSpan("begin 100.5 n1 7 0\n"));
  EXPECT_FALSE(ParseJobSpan("end 100.5 0\n"));
  EXPECT_FALSE(ParseJobSpan(""));
}

// Tests the mean wait of two processors: 1 s and 3 s before the jobs that follow others.
TEST(ArrayFolderTest, WaitsBetweenJobs) {
  EXPECT_THAT(MeanWait_s({{0, 10}, {0, 20}, {11, 30}, {23, 30}}), Optional(DoubleNear(2, 1e-12)));
  EXPECT_EQ(MeanWait_s({{0, 10}, {0, 20}}), std::nullopt);
  EXPECT_EQ(MeanWait_s({}), std::nullopt);
}

}  // namespace
}  // namespace hydro::batch
