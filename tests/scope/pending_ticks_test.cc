#include "scope/signals/pending_ticks.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace hydro::scope {
namespace {

class PendingTicksTest : public ::testing::Test {
 protected:
  void State(int64_t tick, int64_t utime) {
    state_t state{};
    state.tick = tick;
    state.time = static_cast<double>(tick);
    ticks_.Add(state, utime);
  }
  void Command(int64_t tick, double voltage, int64_t utime) {
    motor_command_t command{};
    command.tick = tick;
    command.voltage = voltage;
    command.pressure_ref = 10 * voltage;
    command.pressure_command_tick = 0;
    ticks_.Add(command, utime);
  }
  void Reference(int64_t tick, double value) {
    arm_reference_t reference{};
    reference.tick = tick;
    reference.value = value;
    ticks_.Add(reference);
  }
  std::vector<double> Column(TickColumn column) const {
    std::vector<double> values;
    for (const auto& row : rows_) values.push_back(row[static_cast<size_t>(column)]);
    return values;
  }

  std::vector<PendingTicks::Row> rows_;
  PendingTicks ticks_{[this](double, const PendingTicks::Row& row) { rows_.push_back(row); }};
};

// Tests that a command stands at its tick though it came after the next states, and its latency is from its
// own state on.
TEST_F(PendingTicksTest, LateCommands) {
  for (int64_t tick = 0; tick < 4; ++tick) State(tick, 100 * tick);
  Command(1, 5, 350);
  Command(0, 4, 360);
  Command(3, 7, 380);
  ticks_.Flush();
  EXPECT_EQ(Column(TickColumn::kVoltageAsked), (std::vector<double>{4, 5, 5, 7}));
  EXPECT_EQ(Column(TickColumn::kDpRef), (std::vector<double>{40, 50, 50, 70}));
  const auto latency = Column(TickColumn::kLatency);
  EXPECT_EQ(latency[0], 360);
  EXPECT_EQ(latency[1], 250);
  EXPECT_TRUE(std::isnan(latency[2]));  // held is not answered
  EXPECT_EQ(latency[3], 80);
}

// Tests that a command that arrives before its state waits for it.
TEST_F(PendingTicksTest, EarlyCommands) {
  State(0, 0);
  Command(1, 5, 90);
  Reference(1, 0.3);
  State(1, 100);
  ticks_.Flush();
  EXPECT_EQ(Column(TickColumn::kVoltageAsked)[1], 5);
  EXPECT_EQ(Column(TickColumn::kArmRef)[1], 0.3);
  EXPECT_EQ(Column(TickColumn::kLatency)[1], -10);
}

// Tests that references hold until the next one, also one too late for its own tick.
TEST_F(PendingTicksTest, ReferencesHold) {
  for (int64_t tick = 0; tick < 30; ++tick) {
    State(tick, tick);
    if (tick % 5 == 0 && tick != 10) Reference(tick, static_cast<double>(tick));
    if (tick == 24) Reference(10, 100);
  }
  ticks_.Flush();
  const auto references = Column(TickColumn::kArmRef);
  ASSERT_EQ(references.size(), 30u);
  EXPECT_EQ(references[4], 0);
  EXPECT_EQ(references[5], 5);
  EXPECT_EQ(references[14], 5);
  EXPECT_EQ(references[15], 15);
  EXPECT_EQ(references[29], 25);
}

// Tests that a row waits for eight later ticks and no longer.
TEST_F(PendingTicksTest, WaitsForEightTicks) {
  for (int64_t tick = 0; tick < 8; ++tick) State(tick, tick);
  EXPECT_EQ(rows_.size(), 0u);
  State(8, 8);
  EXPECT_EQ(rows_.size(), 1u);
}

}  // namespace
}  // namespace hydro::scope
