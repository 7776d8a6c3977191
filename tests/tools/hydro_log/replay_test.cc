#include "tools/hydro_log/replay.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cstdlib>
#include <filesystem>

#include "base/input_error.h"
#include "runs/log/log_writer.h"
#include "settings/stack_config.h"
#include "sim/simulation.h"
#include "tests/settings/small_texts.h"
#include "tests/temporary_folder.h"
#include "tests/tools/hydro_log/short_run.h"

namespace hydro::hydro_log {
namespace {

const std::string kConfig = ShortRun("0.3", R"([noise]
p1 = 1.0
motor_speed = 0.1
)");

// A simulated run, recorded into a file and read back.
runs::RunLog Recorded() {
  const TemporaryFolder folder;
  const std::string file = folder / "run.lcmlog";
  const settings::StackConfig config =
      settings::ParseStackConfig(kConfig, "test.toml", settings::kModelText, "model.toml");
  log::LogWriter writer(file, Opening::kTemporary);
  const sim::SimulationResult result = sim::Simulate(config, [&](const bus::RawMessage& m) {
    writer.Append(m.channel, m.data, static_cast<size_t>(m.size), m.receive_utime);
  });
  writer.Finish();
  EXPECT_EQ(result.exit_code, 0) << result.failure;
  return runs::ReadRunLog(file);
}

class ReplayTest : public ::testing::TestWithParam<ReplayedController> {};
INSTANTIATE_TEST_SUITE_P(BothControllers, ReplayTest,
                         ::testing::Values(ReplayedController::kPressure, ReplayedController::kPosition));

// Tests that each controller, given the record, answers it bit by bit.
TEST_P(ReplayTest, IsIdentical) {
  const ReplayResult result = Replay(Recorded(), GetParam(), 0);
  EXPECT_EQ(result.difference, std::nullopt);
  EXPECT_EQ(result.states, 301);
  EXPECT_EQ(result.answers, GetParam() == ReplayedController::kPressure ? 301 : 61);
}

// Tests that the order of arrival in the log does not matter.
TEST_P(ReplayTest, OrderOfArrivalDoesNotMatter) {
  runs::RunLog log = Recorded();
  std::reverse(log.messages.Of<state_t>().begin(), log.messages.Of<state_t>().end());
  std::reverse(log.messages.Of<pressure_command_t>().begin(), log.messages.Of<pressure_command_t>().end());
  EXPECT_EQ(Replay(log, GetParam(), 0).difference, std::nullopt);
}

// Tests that where the record lacks a state the comparison ends and says so: from there on other answers
// prove nothing. Ticks that the plant skipped are no such gap.
TEST_P(ReplayTest, EndsAtAMissingState) {
  runs::RunLog log = Recorded();
  std::vector<state_t>& states = log.messages.Of<state_t>();
  std::erase_if(states, [](const state_t& state) { return state.tick >= 100 && state.tick < 103; });
  const ReplayResult result = Replay(log, GetParam(), 0);
  EXPECT_EQ(result.difference, std::nullopt);
  EXPECT_EQ(result.gap_tick, 100);
  EXPECT_EQ(result.answers, GetParam() == ReplayedController::kPressure ? 100 : 20);
  EXPECT_EQ(result.answers + result.not_compared, GetParam() == ReplayedController::kPressure ? 301 : 61);
  const auto after = std::ranges::find(states, 103, &state_t::tick);
  after->skipped_ticks = 3;
  EXPECT_EQ(Replay(log, GetParam(), 0).gap_tick, std::nullopt);
}

// Tests the same for a pressure command that the pressure loop obeyed and the record lacks.
TEST(ReplayGapTest, EndsAtAMissingPressureCommand) {
  runs::RunLog log = Recorded();
  std::erase_if(log.messages.Of<pressure_command_t>(),
                [](const pressure_command_t& command) { return command.tick == 100; });
  const ReplayResult result = Replay(log, ReplayedController::kPressure, 0);
  EXPECT_EQ(result.difference, std::nullopt);
  EXPECT_EQ(result.gap_tick, 101);
}

// Tests that one flipped bit, in a recorded answer or in a measurement, is found, at its tick.
TEST(ReplayBitTest, OneBitIsFound) {
  runs::RunLog log = Recorded();
  double& voltage = log.messages.Of<motor_command_t>().at(120).voltage;
  voltage = std::bit_cast<double>(std::bit_cast<uint64_t>(voltage) ^ 1);
  const auto wrong_answer = Replay(log, ReplayedController::kPressure, 0).difference;
  ASSERT_TRUE(wrong_answer.has_value());
  EXPECT_NE(wrong_answer->find("tick 120"), std::string::npos) << *wrong_answer;

  log = Recorded();
  double& angle = log.messages.Of<state_t>().at(100).arm_angle;
  angle = std::bit_cast<double>(std::bit_cast<uint64_t>(angle) ^ (1u << 20));
  const auto wrong_input = Replay(log, ReplayedController::kPosition, 0).difference;
  ASSERT_TRUE(wrong_input.has_value());
  EXPECT_NE(wrong_input->find("tick 100"), std::string::npos) << *wrong_input;
}

// Tests that a real-time record with a late pressure command replays exactly: what counts is the command in
// force.
TEST(ReplayLateTest, WhatWasInForceCounts) {
  runs::RunLog log = Recorded();
  // As if the command of tick 50 had arrived after tick 53: the record says which command each answer used,
  // and with those inputs the recorded answers of ticks 51 to 53 must be those of the old command.
  runs::RunLog late = log;
  const auto& law = log.messages;
  const double before = law.Of<pressure_command_t>().at(9).pressure_ref;
  for (motor_command_t& command : late.messages.Of<motor_command_t>()) {
    if (command.tick < 51 || command.tick > 53) continue;
    command.pressure_command_tick = 45;
    command.pressure_ref = before;
  }
  // Only the references were rewritten, not the voltages: the replay must notice, at tick 51 and nowhere
  // else.
  const auto difference = Replay(late, ReplayedController::kPressure, 0).difference;
  ASSERT_TRUE(difference.has_value());
  EXPECT_NE(difference->find("tick 51"), std::string::npos) << *difference;
  EXPECT_NE(difference->find("voltage"), std::string::npos) << *difference;
}

// Tests that a log that begins in the middle of a run, as a rotated one does, replays from the first possible
// tick.
TEST_P(ReplayTest, BeginsInTheMiddle) {
  runs::RunLog log = Recorded();
  const auto cut = [](auto& messages) {
    std::erase_if(messages, [](const auto& m) { return m.tick < 103; });
  };
  cut(log.messages.Of<state_t>());
  cut(log.messages.Of<motor_command_t>());
  cut(log.messages.Of<pressure_command_t>());
  cut(log.messages.Of<arm_reference_t>());
  const ReplayResult result = Replay(log, GetParam(), 0);
  EXPECT_EQ(result.difference, std::nullopt);
  EXPECT_EQ(result.answers, GetParam() == ReplayedController::kPressure ? 195 : 39);
}

// Tests that a log that cannot be replayed says why.
TEST(ReplayErrorTest, SaysWhatIsMissing) {
  runs::RunLog log = Recorded();
  runs::RunLog without = log;
  without.messages.Of<run_description_t>().clear();
  EXPECT_THROW(Replay(without, ReplayedController::kPressure, 0), InputError);
  without = log;
  without.messages.Of<state_t>().clear();
  EXPECT_THROW(Replay(without, ReplayedController::kPressure, 0), InputError);
  without = log;
  without.messages.Of<motor_command_t>().clear();
  EXPECT_THROW(Replay(without, ReplayedController::kPressure, 0), InputError);
  without = log;
  without.messages.Of<pressure_command_t>().clear();
  EXPECT_THROW(Replay(without, ReplayedController::kPosition, 0), InputError);
}

}  // namespace
}  // namespace hydro::hydro_log
