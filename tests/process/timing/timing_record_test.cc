#include "runs/timing/timing_record.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "runs/timing/timing_report.h"

namespace hydro::timing {
namespace {

using testing::HasSubstr;
using testing::Not;

loop_statistics_t Report(const std::string& role, int64_t session, int64_t sequence, bool whole_run) {
  loop_statistics_t report{};
  report.utime = 1'000'000 * sequence;
  report.session = session;
  report.sequence = sequence;
  report.role = role;
  report.host = "rig";
  report.whole_run = whole_run;
  report.interval_s = 1;
  report.cycles = 1000;
  report.period_p50_us = 1000;
  report.period_max_us = 1000 + 100 * static_cast<double>(sequence);
  report.missed_deadlines = sequence;
  report.lost_messages = 2;
  report.queue_depth = 10 - sequence;
  return report;
}

loop_histogram_t Counts(const std::string& role, int64_t session, int64_t sequence) {
  loop_histogram_t histogram{};
  histogram.session = session;
  histogram.sequence = sequence;
  histogram.role = role;
  histogram.host = "rig";
  histogram.quantity = "round_trip";
  histogram.count = 100 * sequence;
  histogram.lowest = 50'000;
  histogram.highest = 900'000;
  histogram.buckets = 2;
  histogram.bucket_first = {49'152, 884'736};
  histogram.bucket_last = {51'199, 917'503};
  histogram.bucket_count = {100 * sequence - 1, 1};
  return histogram;
}

// Tests that of a process that left in order its own sum counts, and of one that was killed what its reports
// add up to, each report once.
TEST(TimingRecordTest, CompleteOrNot) {
  TimingRecord record;
  for (const int64_t sequence : {1, 0, 1, 2}) record.Add(Report("plant", 1, sequence, false));
  record.Add(Report("logger", 2, 0, false));
  loop_statistics_t total = Report("logger", 2, 1, true);
  total.cycles = 1500;
  record.Add(total);
  const auto processes = record.Processes();
  ASSERT_EQ(processes.size(), 2u);
  const TimedProcess& plant = processes[0];
  EXPECT_EQ(plant.role, "plant");
  EXPECT_FALSE(plant.complete);
  EXPECT_EQ(plant.reports.size(), 3u);
  EXPECT_EQ(plant.total.cycles, 3000);
  EXPECT_EQ(plant.total.missed_deadlines, 3);
  EXPECT_EQ(plant.total.lost_messages, 6);
  EXPECT_EQ(plant.total.queue_depth, 10);
  EXPECT_DOUBLE_EQ(plant.total.period_max_us, 1200);
  EXPECT_DOUBLE_EQ(plant.total.interval_s, 3);
  EXPECT_TRUE(processes[1].complete);
  EXPECT_EQ(processes[1].total.cycles, 1500);
}

// Tests that of a quantity the newest histogram counts, whatever order they come in, and its percentiles.
TEST(TimingRecordTest, NewestHistogram) {
  TimingRecord record;
  record.Add(Counts("plant", 1, 2));
  record.Add(Counts("plant", 1, 10));
  record.Add(Counts("plant", 1, 3));
  const auto processes = record.Processes();
  ASSERT_EQ(processes.size(), 1u);
  const TimingHistogram& histogram = processes[0].histograms.at("round_trip");
  EXPECT_EQ(histogram.count, 1000);
  EXPECT_NEAR(histogram.Percentile(0), 50'000, 1600);
  EXPECT_NEAR(histogram.Percentile(50), 50'000, 1600);
  EXPECT_NEAR(histogram.Percentile(99.9), 50'000, 1600);
  EXPECT_DOUBLE_EQ(histogram.Percentile(99.95), 900'000);
  EXPECT_DOUBLE_EQ(histogram.Percentile(100), 900'000);
  EXPECT_DOUBLE_EQ(TimingHistogram().Percentile(50), 0);
}

// Tests that a histogram that none of our processes would send does no harm: lists shorter or longer than
// stated, inverted ranges, empty ones.
TEST(TimingRecordTest, ImproperHistogram) {
  TimingRecord record;
  loop_histogram_t histogram = Counts("plant", 1, 1);
  histogram.buckets = 100;
  histogram.bucket_count = {0, -5};
  record.Add(histogram);
  histogram.quantity = "latency";
  histogram.buckets = -1;
  record.Add(histogram);
  histogram = Counts("plant", 1, 1);
  histogram.quantity = "period";
  histogram.bucket_first[1] = histogram.bucket_last[1] + 1;
  record.Add(histogram);
  const auto processes = record.Processes();
  EXPECT_TRUE(processes[0].histograms.at("round_trip").ranges.empty());
  EXPECT_TRUE(processes[0].histograms.at("latency").ranges.empty());
  EXPECT_EQ(processes[0].histograms.at("period").ranges.size(), 1u);
  EXPECT_THAT(TimingPage(processes, "x"), Not(HasSubstr("nan")));
  EXPECT_NO_THROW(TimingText(processes));
}

// Tests that loops that measured nothing, those of a simulation, are not shown as loops that were killed.
TEST(TimingReportTest, SimulationHasNoTiming) {
  TimingRecord record;
  loop_statistics_t report = Report("plant", 1, 0, false);
  report.cycles = 0;
  record.Add(report);
  const std::string text = TimingText(record.Processes());
  EXPECT_THAT(text, HasSubstr("no timing was measured: a simulation"));
  EXPECT_THAT(text, Not(HasSubstr("without a last report")));
}

// Tests the keys and units of the JSON.
TEST(TimingReportTest, Json) {
  TimingRecord record;
  record.Add(Counts("plant", 1, 10));
  record.Add(Report("plant", 1, 0, true));
  const auto json = nlohmann::json::parse(TimingJson(record.Processes(), "a run"));
  EXPECT_EQ(json["source"], "a run");
  const auto& plant = json["processes"][0];
  EXPECT_EQ(plant["role"], "plant");
  EXPECT_EQ(plant["complete"], true);
  EXPECT_EQ(plant["total"]["cycles"], 1000);
  EXPECT_EQ(plant["histograms"]["round_trip_us"]["count"], 1000);
  EXPECT_NEAR(plant["histograms"]["round_trip_us"]["p50"], 50, 1.6);
  EXPECT_EQ(plant["histograms"]["round_trip_us"]["max"], 900);
  EXPECT_EQ(plant["histograms"]["round_trip_us"]["buckets"][1][2], 1);
}

// Tests that names from the network are plain text on the page and in the JSON.
TEST(TimingReportTest, NamesAreOnlyText) {
  TimingRecord record;
  record.Add(Report("<script>alert(1)</script>\xff", 1, 0, true));
  EXPECT_THAT(TimingPage(record.Processes(), "<b>\"&"), Not(HasSubstr("<script")));
  EXPECT_THAT(TimingPage(record.Processes(), "<b>\"&"), HasSubstr("&lt;b&gt;&quot;&amp;"));
  EXPECT_TRUE(nlohmann::json::accept(TimingJson(record.Processes(), "x")));
}

}  // namespace
}  // namespace hydro::timing
