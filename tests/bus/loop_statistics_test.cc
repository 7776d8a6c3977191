#include "bus/loop_statistics.h"

#include <gtest/gtest.h>

namespace hydro {
namespace {

using namespace std::chrono_literals;

constexpr Clock::TimePoint kStart{5s};

// Tests that a report comes once a second and holds what happened since the one before.
TEST(LoopStatisticsTest, ReportsEachSecond) {
  LoopStatistics statistics("plant", "rig", 7, kStart);
  for (int i = 0; i < 1000; ++i) {
    EXPECT_FALSE(statistics.Poll(kStart + i * 1ms).has_value());
    statistics.RecordCycle(kStart + i * 1ms, i < 990 ? 20us : 500us);
  }
  statistics.set_lost_messages(3);
  statistics.AddMissedDeadlines(2);
  statistics.RecordQueueDepth(9);
  statistics.RecordQueueDepth(4);
  auto report = statistics.Poll(kStart + 1s);
  ASSERT_TRUE(report.has_value());
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

  EXPECT_FALSE(statistics.Poll(kStart + 1500ms).has_value());
  statistics.RecordCycle(kStart + 1600ms, 1us);
  statistics.set_lost_messages(4);
  report = statistics.Poll(kStart + 3s);  // late: the interval says so
  ASSERT_TRUE(report.has_value());
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
    statistics.AddLostMessages(1);
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

}  // namespace
}  // namespace hydro
