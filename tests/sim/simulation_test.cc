#include "sim/simulation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <hydro/motor_command_t.hpp>
#include <hydro/pressure_command_t.hpp>
#include <hydro/state_t.hpp>
#include <string>
#include <vector>

#include "base/input_error.h"
#include "tests/stack_fixture.h"

namespace hydro::sim {
namespace {

using testing::SmallStack;

// What a run says, as bytes in order.
struct Recording {
  std::vector<std::string> channels;
  std::vector<std::string> messages;

  std::function<void(const bus::RawMessage&)> Tap() {
    return [this](const bus::RawMessage& m) {
      channels.emplace_back(m.channel);
      messages.emplace_back(reinterpret_cast<const char*>(m.data), static_cast<size_t>(m.size));
    };
  }

  template <class Message>
  std::vector<Message> All(const std::string& channel) const {
    std::vector<Message> all;
    for (size_t i = 0; i < channels.size(); ++i) {
      if (channels[i] != channel) continue;
      Message message;
      EXPECT_GT(message.decode(messages[i].data(), 0, static_cast<int>(messages[i].size())), 0);
      all.push_back(message);
    }
    return all;
  }
};

settings::StackConfig Step() {
  settings::StackConfig config = SmallStack();
  config.plant.rate_hz = 5000;
  config.position_interval_ticks = 25;
  config.reference.trajectory.steps = {{0.01, 0.1}};
  config.last_tick = 2000;
  return config;
}

// Tests that the whole stack runs: every tick has a state and a motor command, every 25th a pressure command.
TEST(SimulationTest, RunsTheWholeStack) {
  Recording recording;
  const SimulationResult result = Simulate(Step(), recording.Tap());
  EXPECT_EQ(result.exit_code, 0) << result.failure;
  EXPECT_EQ(result.ticks, 2000);
  const auto states = recording.All<state_t>("HYDRO_STATE");
  ASSERT_EQ(states.size(), 2001u);
  EXPECT_EQ(recording.All<pressure_command_t>("HYDRO_PRESSURE_COMMAND").size(), 81u);
  const auto commands = recording.All<motor_command_t>("HYDRO_MOTOR_COMMAND");
  ASSERT_EQ(commands.size(), 2002u);  // the last is the zero at the end of the run
  EXPECT_EQ(commands.back().voltage, 0);
  EXPECT_EQ(commands.back().status, motor_command_t::STOPPED);
  EXPECT_GT(states.back().arm_angle, 0.005);
}

// Tests that two runs are the same to the last bit, message by message.
TEST(SimulationTest, IsRepeatable) {
  settings::StackConfig config = Step();
  config.noise.p1_psi = 2;
  Recording a, b;
  Simulate(config, a.Tap());
  Simulate(config, b.Tap());
  EXPECT_EQ(a.channels, b.channels);
  EXPECT_EQ(a.messages, b.messages);
}

// Tests that logging changes nothing: the state reached without a tap is that reached with one.
TEST(SimulationTest, LoggingDoesNotDisturb) {
  Recording recording;
  const SimulationResult with = Simulate(Step(), recording.Tap());
  const SimulationResult without = Simulate(Step(), nullptr);
  EXPECT_EQ(with.ticks, without.ticks);
  EXPECT_EQ(with.exit_code, without.exit_code);
}

// Tests that a tripped limit ends the run as failed and says why.
TEST(SimulationTest, TrippedLimitFails) {
  settings::StackConfig config = Step();
  config.limits.pressure_psi = 105;
  const SimulationResult result = Simulate(config, nullptr);
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.failure.find("pressure_limit"), std::string::npos);
  EXPECT_LT(result.ticks, 2000);
}

// Tests that a simulation without an end is refused.
TEST(SimulationTest, NeedsADuration) {
  settings::StackConfig config = Step();
  config.last_tick = -1;
  EXPECT_THROW(Simulate(config, nullptr), InputError);
}

}  // namespace
}  // namespace hydro::sim
