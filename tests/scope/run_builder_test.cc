#include "scope/signals/run_builder.h"

#include <gtest/gtest.h>

#include <hydro/messages.hpp>
#include <limits>
#include <memory>
#include <vector>

#include "scope/signals/decoded.h"
#include "tests/scope/recorded_run.h"

namespace hydro::scope {
namespace {

class RunBuilderTest : public ::testing::Test {
 protected:
  template <class Message>
  void Take(const std::string& channel, const Message& message) {
    const RecordedMessage recorded = Encoded(channel, message, utime_);
    run_builder_.Take(recorded.channel, recorded.data.data(), static_cast<int>(recorded.data.size()),
                      recorded.utime);
  }
  void State(int64_t tick, int64_t session = 7) {
    utime_ += 1000;
    state_t state{};
    state.tick = tick;
    state.sequence = tick;
    state.session = session;
    state.time = static_cast<double>(tick) / 1000;
    state.p1 = static_cast<double>(tick);
    Take("HYDRO_STATE", state);
  }
  void Fault(int64_t sequence, bool active) {
    fault_t fault{};
    fault.session = 3;
    fault.sequence = sequence;
    fault.tick = -1;
    fault.source = "pressure_ctrl";
    fault.code = "stale_state";
    fault.text = "no state for 0.1 s";
    fault.active = active ? 1 : 0;
    Take("HYDRO_FAULT", fault);
  }
  void ActiveFaults(const std::string& codes) {
    active_faults_t active{};
    active.role = "pressure_ctrl";
    active.codes = codes;
    Take("HYDRO_ACTIVE_FAULTS", active);
  }
  std::vector<std::string> Kinds() const {
    std::vector<std::string> kinds;
    const EventList& events = runs_.back()->events;
    for (uint64_t n = events.first(); n <= events.last(); ++n) kinds.push_back(events.At(n).kind);
    return kinds;
  }

  int64_t utime_ = 1000000;
  std::vector<std::unique_ptr<scope::Run>> runs_;
  RunBuilder run_builder_{
      "", [this](int64_t) {
        runs_.push_back(std::make_unique<scope::Run>(0, "test", scope::Run::Kind::kLive, 100000));
        return runs_.back().get();
      }};
};

// Tests that every state of a recorded run becomes a row with its exact values, and that the commands stand
// at their ticks.
TEST_F(RunBuilderTest, TakesARun) {
  std::vector<state_t> states;
  std::vector<motor_command_t> commands;
  for (const RecordedMessage& message : Record(DemoConfig({"time.mode=lockstep", "time.duration_s=1"}))) {
    const int size = static_cast<int>(message.data.size());
    if (message.channel == "HYDRO_STATE") {
      EXPECT_TRUE(Decoded(&states.emplace_back(), message.data.data(), size));
    }
    if (message.channel == "HYDRO_MOTOR_COMMAND") {
      EXPECT_TRUE(Decoded(&commands.emplace_back(), message.data.data(), size));
    }
    run_builder_.Take(message.channel, message.data.data(), size, message.utime);
  }
  run_builder_.Flush();
  ASSERT_EQ(runs_.size(), 1u);
  const auto& run = *runs_[0];
  ASSERT_EQ(run.ticks.end(), states.size());
  EXPECT_EQ(run.rate_hz, 1000);
  ASSERT_NE(run.config, nullptr) << run.config_problem;
  const auto value = [&](size_t row, TickColumn column) {
    return run.ticks.value(row, static_cast<size_t>(column));
  };
  for (size_t k = 0; k < states.size(); ++k) {
    ASSERT_EQ(run.ticks.time(k), states[k].time);
    ASSERT_EQ(value(k, TickColumn::kP1), states[k].p1);
    ASSERT_EQ(value(k, TickColumn::kDp), states[k].p2 - states[k].p1);
    ASSERT_EQ(value(k, TickColumn::kVoltage), states[k].voltage);
    ASSERT_EQ(value(k, TickColumn::kArmRef), states[k].time < 0.2 ? 0 : 0.3);
  }
  for (const motor_command_t& command : commands) {
    const auto row = static_cast<size_t>(command.tick);
    if (command.status == motor_command_t::STOPPED) continue;
    ASSERT_EQ(value(row, TickColumn::kVoltageAsked), command.voltage);
    if (command.pressure_command_tick >= 0) {
      ASSERT_EQ(value(row, TickColumn::kDpRef), command.pressure_ref);
    }
  }
  EXPECT_EQ(Kinds().front(), "step");
  EXPECT_EQ(runs_[0]->events.At(1).t, 0.2);
}

// Tests that missing states are a gap, and repeated ones nothing.
TEST_F(RunBuilderTest, Gaps) {
  for (const int64_t tick : {0, 1, 2, 2, 1, 6, 7}) State(tick);
  run_builder_.Flush();
  EXPECT_EQ(runs_[0]->ticks.end(), 5u);
  EXPECT_EQ(Kinds(), (std::vector<std::string>{"gap"}));
  EXPECT_EQ(runs_[0]->events.At(1).text, "3 states missing");
  EXPECT_EQ(runs_[0]->events.At(1).t, 0.006);
}

// Tests that ticks which a numbered record passes over without saying so are a gap (rows that were taken out
// of an imported table), and those that a late plant says it has skipped are none.
TEST_F(RunBuilderTest, MissingTicks) {
  state_t state{};
  state.session = 7;
  for (const auto& [tick, skipped] :
       {std::pair<int64_t, int64_t>{0, 0}, {1, 0}, {6, 4}, {7, 0}, {10, 0}, {12, 0}}) {
    state.tick = tick;
    state.time = 0.001 * static_cast<double>(tick);
    state.skipped_ticks = skipped;
    Take("HYDRO_STATE", state);
    ++state.sequence;
  }
  EXPECT_EQ(Kinds(), (std::vector<std::string>{"gap", "gap"}));
  EXPECT_EQ(runs_[0]->events.At(1).text, "ticks 8 to 9 missing");
  EXPECT_EQ(runs_[0]->events.At(2).text, "tick 11 missing");
}

// Tests that a fault is an event once, however often its message comes.
TEST_F(RunBuilderTest, FaultsAreEventsOnce) {
  State(0);
  Fault(0, true);
  Fault(0, true);
  ActiveFaults("stale_state");
  ActiveFaults("stale_state");
  Fault(1, false);
  ActiveFaults("");
  EXPECT_EQ(Kinds(), (std::vector<std::string>{"fault", "fault_end"}));
  EXPECT_EQ(runs_[0]->events.At(1).code, "stale_state");
  EXPECT_EQ(runs_[0]->events.At(1).source, "pressure_ctrl");
}

// Tests that a fault whose message was lost is known from the list, and its end too: not at the first list
// without it, which may have been sent before.
TEST_F(RunBuilderTest, LostFaultsAreMadeGood) {
  State(0);
  ActiveFaults("stale_state limit");
  EXPECT_EQ(Kinds(), (std::vector<std::string>{"fault", "fault"}));
  ActiveFaults("limit");
  EXPECT_EQ(Kinds().size(), 2u);
  ActiveFaults("limit");
  EXPECT_EQ(Kinds(), (std::vector<std::string>{"fault", "fault", "fault_end"}));
}

// Tests that a plant that starts again begins a new run, and a second one beside it does not.
TEST_F(RunBuilderTest, FollowsOnePlant) {
  for (int64_t tick = 0; tick < 10; ++tick) {
    State(tick);
    State(tick, 8);
  }
  EXPECT_EQ(runs_.size(), 1u);
  EXPECT_EQ(run_builder_.foreign(), 10);
  utime_ += 2000000;  // silence
  State(0, 8);
  ASSERT_EQ(runs_.size(), 2u);
  EXPECT_EQ(runs_[0]->ticks.end(), 10u);
  EXPECT_EQ(Kinds(), (std::vector<std::string>{"restart"}));
}

// Tests that after a stop the next plant need not wait, and that a stop sent many times is one event.
TEST_F(RunBuilderTest, Stops) {
  State(0);
  stop_t stop{};
  stop.tick = 0;
  stop.source = "launch";
  stop.reason = "hydro-launch --stop";
  for (int i = 0; i < 5; ++i) Take("HYDRO_STOP", stop);
  EXPECT_EQ(Kinds(), (std::vector<std::string>{"stop"}));
  State(0, 9);
  EXPECT_EQ(runs_.size(), 2u);
}

// Tests that reports make processes and channels known, and that made-up roles are bounded.
TEST_F(RunBuilderTest, Reports) {
  State(0);
  loop_statistics_t statistics{};
  for (int i = 0; i < 1000; ++i) {
    statistics.role = "role" + std::to_string(i);
    statistics.host = "rig";
    statistics.interval_s = 1;
    statistics.cycles = 1000;
    statistics.latency_p99_us = 42;
    Take("HYDRO_LOOP_STATISTICS", statistics);
  }
  EXPECT_EQ(runs_[0]->processes.size(), 64u);
  EXPECT_EQ(runs_[0]->loops.size(), 64u);
  EXPECT_EQ(runs_[0]->processes.at("role0 on rig").rate_hz, 1000);
  ASSERT_TRUE(runs_[0]->Find("loop.role0.latency_p99_us"));
  EXPECT_EQ(runs_[0]->loops.at("role0").value(0, 0), 42);
}

// Tests that the largest and smallest numbers of foreign messages do no harm.
TEST_F(RunBuilderTest, ExtremeNumbers) {
  constexpr int64_t kMost = std::numeric_limits<int64_t>::max();
  constexpr int64_t kLeast = std::numeric_limits<int64_t>::min();
  for (const int64_t number : {kMost, kLeast, int64_t{0}, kMost}) {
    utime_ = number;
    state_t state{};
    state.tick = state.sequence = number;
    state.time = number > 0 ? 1e300 : 1;
    Take("HYDRO_STATE", state);
    state.time = 2;
    Take("HYDRO_STATE", state);
    motor_command_t command{};
    command.tick = number;
    Take("HYDRO_MOTOR_COMMAND", command);
    fault_t fault{};
    fault.tick = fault.sequence = number;
    Take("HYDRO_FAULT", fault);
    stop_t stop{};
    stop.tick = number;
    Take("HYDRO_STOP", stop);
    loop_statistics_t statistics{};
    statistics.missed_deadlines = statistics.lost_messages = number;
    Take("HYDRO_LOOP_STATISTICS", statistics);
    run_description_t description{};
    description.rate_hz = 1e-300;
    Take("HYDRO_RUN", description);
  }
  run_builder_.Flush();
  EXPECT_EQ(run_builder_.undecodable(), 0);
  EXPECT_GT(runs_.back()->events.last(), 0u);
}

// Tests that what is no message is counted and left out.
TEST_F(RunBuilderTest, Undecodable) {
  State(0);
  const uint8_t bytes[40] = {};
  for (const char* channel :
       {"HYDRO_STATE", "HYDRO_MOTOR_COMMAND", "HYDRO_ARM_REFERENCE", "HYDRO_FAULT", "HYDRO_RUN"}) {
    run_builder_.Take(channel, bytes, sizeof bytes, 0);
    run_builder_.Take(channel, bytes, 0, 0);
  }
  run_builder_.Take("ANOTHER", bytes, sizeof bytes, 0);
  EXPECT_EQ(run_builder_.undecodable(), 10);
  EXPECT_EQ(runs_.size(), 1u);
}

}  // namespace
}  // namespace hydro::scope
