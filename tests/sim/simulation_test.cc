#include "sim/simulation.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <hydro/arm_reference_t.hpp>
#include <hydro/motor_command_t.hpp>
#include <hydro/pressure_command_t.hpp>
#include <hydro/state_t.hpp>
#include <map>
#include <string>
#include <vector>

#include "base/input_error.h"
#include "bus/in_process_bus.h"
#include "plant/plant_app.h"
#include "plant/simulated_rig.h"
#include "position_ctrl/position_app.h"
#include "pressure_ctrl/pressure_app.h"
#include "tests/sim/limb/limb_fixture.h"
#include "tests/stack_fixture.h"

namespace hydro::sim {
namespace {

using testing::SmallStack;

// The messages of a run, as bytes in order.
struct Recording {
  std::vector<std::string> channels;
  std::vector<std::string> messages;

  std::function<void(const bus::RawMessage&)> Tap() {
    return [this](const bus::RawMessage& m) {
      channels.emplace_back(m.channel);
      messages.emplace_back(reinterpret_cast<const char*>(m.data), static_cast<size_t>(m.size));
    };
  }

  std::vector<std::string> Bytes(const std::string& channel) const {
    std::vector<std::string> all;
    for (size_t i = 0; i < channels.size(); ++i) {
      if (channels[i] == channel) all.push_back(messages[i]);
    }
    return all;
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

// Tests a machine that is not the model: the model as the machine changes nothing; another one moves in
// another way, under laws, limits and announcements that stay the model's.
TEST(SimulationTest, RunsAnotherMachineThanTheModel) {
  const settings::StackConfig config = Step();
  model::ModelDescription machine = config.model.description;
  Recording known, same, other;
  Simulate(config, known.Tap());
  Simulate(config, same.Tap(), {}, &machine);
  EXPECT_EQ(same.messages, known.messages);
  machine.parameters.J_a *= 2;
  machine.parameters.D *= 0.9;
  EXPECT_EQ(Simulate(config, other.Tap(), {}, &machine).exit_code, 0);
  const auto states = other.All<state_t>("HYDRO_STATE");
  EXPECT_NE(states.back().arm_angle, known.All<state_t>("HYDRO_STATE").back().arm_angle);
  EXPECT_EQ(other.Bytes("HYDRO_CONFIGURATION"), known.Bytes("HYDRO_CONFIGURATION"));
  // The first command after the step answers a machine that has not moved yet: the same law gives the same
  // voltage.
  const auto first = [](const Recording& recording) {
    for (const auto& command : recording.All<motor_command_t>("HYDRO_MOTOR_COMMAND")) {
      if (command.voltage != 0) return command.voltage;
    }
    return 0.0;
  };
  EXPECT_NE(first(known), 0);
  EXPECT_EQ(first(other), first(known));
}

// The messages of one channel as a handler of their type is given them: encoded here, and nowhere else.
template <class Message>
void Watch(bus::Bus& bus, const std::string& channel, std::vector<std::string>& seen) {
  bus.Subscribe<Message>(channel, [&seen](const Message& message) {
    std::string bytes(static_cast<size_t>(message.getEncodedSize()), '\0');
    message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
    seen.push_back(std::move(bytes));
  });
}

// Tests that every simulation has a session, the same for the same one, and that another seed, reference or
// model gives another.
TEST(SimulationTest, Sessions) {
  const settings::StackConfig config = Step();
  settings::StackConfig other_text = config, other_model = config;
  other_text.text += "# ";
  other_model.model.text += "# ";
  EXPECT_GT(SessionOf(config), 0);
  EXPECT_EQ(SessionOf(config), SessionOf(Step()));
  EXPECT_NE(SessionOf(config), SessionOf(other_text));
  EXPECT_NE(SessionOf(config), SessionOf(other_model));
  EXPECT_GT(SessionOf(settings::StackConfig{}), 0);
}

// Tests that logging changes nothing: without a tap, where nothing is encoded, every state and every command
// is to the last bit what a tap records.
TEST(SimulationTest, LoggingDoesNotDisturb) {
  settings::StackConfig config = Step();
  config.noise.p1_psi = 2;
  Recording recording;
  const SimulationResult with = Simulate(config, recording.Tap());

  config.time.mode = settings::TimeMode::kLockstep;
  bus::SimulatedClock clock(SessionOf(config));
  bus::InProcessBus bus(&clock);
  std::map<std::string, std::vector<std::string>> seen;
  Watch<state_t>(bus, "HYDRO_STATE", seen["HYDRO_STATE"]);
  Watch<pressure_command_t>(bus, "HYDRO_PRESSURE_COMMAND", seen["HYDRO_PRESSURE_COMMAND"]);
  Watch<motor_command_t>(bus, "HYDRO_MOTOR_COMMAND", seen["HYDRO_MOTOR_COMMAND"]);
  plant::SimulatedRig rig(config);
  plant::PlantApp plant(bus, clock, config, rig, {}, "hydro-sim");
  pressure_ctrl::PressureApp pressure(bus, clock, config);
  position_ctrl::PositionApp position(bus, clock, config);
  EXPECT_EQ(plant.Run(), with.exit_code);
  const auto dispatch_all = [&] {
    while (bus.HandleUntil(clock.Now()) > 0) {
    }
  };
  dispatch_all();
  position.Finish();
  pressure.Finish();
  dispatch_all();
  EXPECT_EQ(plant.tick(), with.ticks);

  EXPECT_EQ(seen.at("HYDRO_STATE").size(), 2001u);
  for (const auto& [channel, messages] : seen) {
    EXPECT_EQ(messages, recording.Bytes(channel)) << channel;
  }
  // The same run through Simulate(), which tells only how it ended.
  const SimulationResult without = Simulate(config, nullptr);
  EXPECT_EQ(with.ticks, without.ticks);
  EXPECT_EQ(with.duration, without.duration);
  EXPECT_EQ(with.exit_code, without.exit_code);
  EXPECT_EQ(with.failure, without.failure);
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

// Tests that a fault that holds the voltage at zero to the end is told in the words of hydro-launch, with or
// without a tap, and that a run without one tells nothing.
TEST(SimulationTest, TellsFaultsThatAreLeft) {
  settings::StackConfig config = Step();
  Recording recording;
  for (const auto& tap : {std::function<void(const bus::RawMessage&)>(), recording.Tap()}) {
    config.noise.p1_resolution_psi = 0;
    const SimulationResult good = Simulate(config, tap);
    EXPECT_EQ(good.faults_left, "");
    EXPECT_THAT(good.fault_lines, ::testing::IsEmpty());
    config.noise.p1_resolution_psi = INFINITY;  // 0 times infinity is what p1 reads
    const SimulationResult held = Simulate(config, tap);
    EXPECT_EQ(held.ticks, 2000);
    EXPECT_THAT(held.faults_left,
                ::testing::AllOf(::testing::StartsWith("the run ended with active faults: "),
                                 ::testing::HasSubstr("nonfinite_state of pressure_ctrl")));
    EXPECT_THAT(held.fault_lines,
                ::testing::Contains(::testing::StartsWith(
                    "fault nonfinite_state of pressure_ctrl, once, still there at the end: ")));
  }
}

// Tests that an endless simulation is refused.
TEST(SimulationTest, NeedsADuration) {
  settings::StackConfig config = Step();
  config.last_tick = -1;
  EXPECT_THROW(Simulate(config, nullptr), InputError);
}

// Tests that each joint of a limb says, message by message and bit by bit, what it says alone, and that the
// limb describes itself.
TEST(SimulateLimbTest, EachJointAsAlone) {
  const settings::LimbConfig limb = testing::SmallLimb({"hip", "knee", "ankle"});
  Recording together;
  const SimulationResult result = SimulateLimb(limb, together.Tap());
  EXPECT_EQ(result.exit_code, 0);
  EXPECT_EQ(result.ticks, 100);
  EXPECT_THAT(together.Bytes("HYDRO_RUN"), ::testing::ElementsAre(::testing::HasSubstr(limb.common.text)));
  for (const settings::JointConfig& joint : limb.joints) {
    Recording alone;
    EXPECT_EQ(Simulate(joint.config, alone.Tap()).exit_code, 0);
    const bus::Channels channels("_" + joint.name);
    for (const std::string& channel : {channels.Of<state_t>(), channels.Of<motor_command_t>(),
                                       channels.Of<pressure_command_t>(), channels.Of<arm_reference_t>()}) {
      EXPECT_EQ(together.Bytes(channel), alone.Bytes(channel)) << channel;
      EXPECT_FALSE(alone.Bytes(channel).empty());
    }
  }
}

// Tests that the faults of a limb are told with the joints' names.
TEST(SimulateLimbTest, TellsFaultsThatAreLeft) {
  settings::LimbConfig limb = testing::SmallLimb({"hip", "knee"});
  EXPECT_EQ(SimulateLimb(limb, {}).faults_left, "");
  limb.joints[0].config.noise.p1_resolution_psi = INFINITY;
  EXPECT_THAT(SimulateLimb(limb, {}).faults_left,
              ::testing::HasSubstr("nonfinite_state of hip pressure_ctrl"));
}

}  // namespace
}  // namespace hydro::sim
