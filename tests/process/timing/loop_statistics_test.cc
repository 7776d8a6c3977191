#include "process/timing/loop_statistics.h"

#include <gtest/gtest.h>

#include <vector>

namespace hydro::timing {
namespace {

using namespace std::chrono_literals;

constexpr bus::Clock::TimePoint kStart{5s};

// Tests that a report comes once a second and holds what happened since the one before.
TEST(LoopStatisticsTest, ReportsEachSecond) {
  LoopStatistics statistics("plant", "rig", 7, kStart);
  for (int i = 0; i < 1000; ++i) {
    EXPECT_EQ(statistics.Poll(kStart + i * 1ms), nullptr);
    statistics.RecordCycle(kStart + i * 1ms, i < 990 ? 20us : 500us);
  }
  statistics.set_lost_messages(3);
  statistics.AddMissedDeadlines(2);
  statistics.RecordQueueDepth(9);
  statistics.RecordQueueDepth(4);
  loop_statistics_t* report = statistics.Poll(kStart + 1s);
  ASSERT_NE(report, nullptr);
  EXPECT_EQ(report->role, "plant");
  EXPECT_EQ(report->host, "rig");
  EXPECT_EQ(report->session, 7);
  EXPECT_EQ(report->sequence, 0);
  EXPECT_DOUBLE_EQ(report->interval_s, 1.0);
  EXPECT_EQ(report->cycles, 1000);
  EXPECT_NEAR(report->period_p50_us, 1000, 10);
  EXPECT_DOUBLE_EQ(report->period_max_us, 1000);
  EXPECT_NEAR(report->latency_p50_us, 20, 0.2);
  EXPECT_NEAR(report->latency_p99_us, 20, 0.2);
  EXPECT_NEAR(report->latency_p999_us, 500, 5);
  EXPECT_DOUBLE_EQ(report->latency_max_us, 500);
  EXPECT_EQ(report->lost_messages, 3);
  EXPECT_EQ(report->missed_deadlines, 2);
  EXPECT_EQ(report->queue_depth, 9);

  EXPECT_EQ(statistics.Poll(kStart + 1500ms), nullptr);
  statistics.RecordCycle(kStart + 1600ms, 1us);
  statistics.set_lost_messages(4);
  report = statistics.Poll(kStart + 3s);  // late: the interval says so
  ASSERT_NE(report, nullptr);
  EXPECT_EQ(report->sequence, 1);
  EXPECT_DOUBLE_EQ(report->interval_s, 2.0);
  EXPECT_EQ(report->cycles, 1);
  EXPECT_DOUBLE_EQ(report->period_max_us, 601'000);  // across the report
  EXPECT_EQ(report->lost_messages, 1);
  EXPECT_EQ(report->missed_deadlines, 0);
  EXPECT_EQ(report->queue_depth, 0);
}

// Tests that the total covers all reports and what came after the last one.
TEST(LoopStatisticsTest, TotalCoversTheRun) {
  LoopStatistics statistics("logger", "rig", 7, kStart);
  for (int i = 0; i < 2500; ++i) {
    statistics.RecordCycle(kStart + i * 1ms, 10us);
    statistics.RecordQueueDepth(i == 100 ? 50 : 1);
    statistics.set_lost_messages(i + 1);
    statistics.Poll(kStart + i * 1ms);
  }
  const loop_statistics_t total = statistics.Total(kStart + 2500ms);
  EXPECT_EQ(total.cycles, 2500);
  EXPECT_DOUBLE_EQ(total.interval_s, 2.5);
  EXPECT_EQ(total.lost_messages, 2500);
  EXPECT_EQ(total.queue_depth, 50);
  EXPECT_DOUBLE_EQ(total.period_max_us, 1000);
  EXPECT_NEAR(total.latency_p50_us, 10, 0.1);
}

// Tests that every two seconds the histogram of each quantity that has any values comes, one at a time, over
// the whole run so far.
TEST(LoopStatisticsTest, HistogramsInTurn) {
  LoopStatistics statistics("plant", "rig", 7, kStart);
  for (int i = 0; i < 1000; ++i) statistics.RecordCycle(kStart + i * 1ms, 20us);
  statistics.RecordRoundTrip(60us);
  statistics.AddMissedDeadlines(2);
  statistics.AddMissedDeadlines(2500);
  statistics.set_lost_messages(0);
  ASSERT_NE(statistics.Poll(kStart + 1s), nullptr);
  EXPECT_EQ(statistics.PollHistogram(kStart + 1999ms), nullptr);
  std::vector<loop_histogram_t> histograms;
  while (const loop_histogram_t* due = statistics.PollHistogram(kStart + 2s)) histograms.push_back(*due);
  ASSERT_EQ(histograms.size(), 4u);
  EXPECT_EQ(histograms[0].quantity, "period");
  EXPECT_EQ(histograms[1].quantity, "latency");
  EXPECT_EQ(histograms[2].quantity, "round_trip");
  EXPECT_EQ(histograms[3].quantity, "skipped");
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(histograms[i].sequence, i);
    EXPECT_EQ(histograms[i].role, "plant");
    EXPECT_EQ(histograms[i].host, "rig");
    EXPECT_EQ(histograms[i].session, 7);
    EXPECT_EQ(histograms[i].whole_run, 0);
    EXPECT_DOUBLE_EQ(histograms[i].interval_s, 2.0);
    EXPECT_EQ(histograms[i].buckets, static_cast<int>(histograms[i].bucket_count.size()));
  }
  EXPECT_EQ(histograms[0].count, 999);
  EXPECT_EQ(histograms[0].lowest, 1'000'000);
  ASSERT_EQ(histograms[0].buckets, 1);
  EXPECT_LE(histograms[0].bucket_first[0], 1'000'000);
  EXPECT_GE(histograms[0].bucket_last[0], 1'000'000);
  EXPECT_EQ(histograms[0].bucket_count[0], 999);
  EXPECT_EQ(histograms[2].highest, 60'000);
  EXPECT_EQ(histograms[3].count, 2);  // two times, of 2 and 2500 in a row
  EXPECT_EQ(histograms[3].lowest, 2);
  EXPECT_EQ(histograms[3].highest, 2500);

  // What comes between two reports is in the total, and still in the report after it.
  statistics.RecordCycle(kStart + 2100ms, 1s);
  const loop_histogram_t* total = statistics.TotalHistogram(LoopQuantity::kLatency, kStart + 2200ms);
  ASSERT_NE(total, nullptr);
  EXPECT_EQ(total->count, 1001);
  EXPECT_EQ(total->highest, 1'000'000'000);
  EXPECT_NE(total->whole_run, 0);
  EXPECT_EQ(statistics.TotalHistogram(LoopQuantity::kGap, kStart + 2200ms), nullptr);
  ASSERT_NE(statistics.Poll(kStart + 3s), nullptr);
  total = statistics.TotalHistogram(LoopQuantity::kLatency, kStart + 3s);
  EXPECT_EQ(total->count, 1001);
}

}  // namespace
}  // namespace hydro::timing
