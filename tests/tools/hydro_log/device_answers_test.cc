#include "tools/hydro_log/device_answers.h"

#include <gtest/gtest.h>

#include <cmath>

#include "firmware/law.h"
#include "settings/stack_config.h"
#include "tests/settings/small_texts.h"

namespace hydro::hydro_log {
namespace {

using pressure_ctrl::PressureLawSettings;

constexpr int kTicks = 400;

PressureLawSettings Law(double k_p) {
  PressureLawSettings law;
  law.gains = {.k_p = k_p, .k_v = 0.3};
  law.reference_feedforward = 0.002;
  law.voltage_limit = 10;
  return law;
}

double ReferenceAt(int64_t tick) { return std::floor(static_cast<double>(tick) / 5) - 20; }

state_t StateAt(int64_t tick) {
  state_t state{};
  state.tick = tick;
  state.p1 = static_cast<float>(100 + 10 * std::sin(0.1 * static_cast<double>(tick)));
  state.p2 = static_cast<float>(120 + 3 * std::cos(0.07 * static_cast<double>(tick)));
  state.motor_speed = static_cast<float>(40 * std::sin(0.03 * static_cast<double>(tick)));
  return state;
}

// A device that obeys what it was sent two ticks before.
std::map<int64_t, motor_command_t> RecordedRun() {
  std::map<int64_t, motor_command_t> commands;
  for (int64_t tick = 2; tick < kTicks; ++tick) {
    const state_t state = StateAt(tick);
    const PressureLawSettings law = Law(0.02);
    const hydro_gains gains = {.k_p = static_cast<float>(law.gains.k_p),
                               .k_v = 0.3F,
                               .reference_feedforward = 0.002F,
                               .arm_speed_ratio = 0};
    const hydro_law_input input = {.pressure_ref = static_cast<float>(ReferenceAt(tick - 2)),
                                   .p1 = static_cast<float>(state.p1),
                                   .p2 = static_cast<float>(state.p2),
                                   .motor_speed = static_cast<float>(state.motor_speed),
                                   .arm_speed = 0};
    motor_command_t command{};
    command.tick = tick;
    command.status = motor_command_t::LAW;
    command.pressure_ref = input.pressure_ref;
    command.voltage = hydro_law(&gains, &input);
    commands.emplace(tick, command);
  }
  return commands;
}

settings::StackConfig Config() {
  return settings::ParseStackConfig(settings::kConfigText, "stack.toml", settings::kModelText, "model.toml");
}

// How many answers of a replay differ from the record; the gains are other ones from `change` on.
struct Judged {
  int differ = 0;
  int64_t not_judged = 0;
};
Judged Replayed(const std::map<int64_t, motor_command_t>& recorded, int64_t change = kTicks) {
  DeviceAnswers device(Config(), recorded);
  Judged judged;
  for (int64_t tick = 0; tick < kTicks; ++tick) {
    const auto answer = device.Follow(StateAt(tick), ReferenceAt(tick), Law(tick < change ? 0.02 : 0.03));
    const auto found = recorded.find(tick);
    if (found == recorded.end()) continue;
    judged.differ +=
        answer.voltage != found->second.voltage || answer.pressure_ref != found->second.pressure_ref;
  }
  judged.not_judged = device.not_judged();
  return judged;
}

// Tests that right answers pass as they were recorded, whatever the delay, each of them judged.
TEST(DeviceAnswersTest, RightOnes) {
  const Judged judged = Replayed(RecordedRun());
  EXPECT_EQ(judged.differ, 0);
  EXPECT_EQ(judged.not_judged, 0);
}

// Tests that a voltage which is wrong beyond the rounding of single precision is found, and one within it is
// not.
TEST(DeviceAnswersTest, WrongVoltage) {
  auto recorded = RecordedRun();
  recorded[200].voltage += 1e-4;
  recorded[201].voltage = std::nextafter(static_cast<float>(recorded[201].voltage), 100.0F);
  EXPECT_EQ(Replayed(recorded).differ, 1);
  recorded = RecordedRun();
  recorded[200].voltage = 1;
  recorded[200].saturated = 1;
  EXPECT_EQ(Replayed(recorded).differ, std::fabs(RecordedRun()[200].voltage) < 1 ? 1 : 0);
}

// Tests that a reference which nobody has sent is found.
TEST(DeviceAnswersTest, WrongReference) {
  auto recorded = RecordedRun();
  recorded[300].pressure_ref += 0.5;
  EXPECT_EQ(Replayed(recorded).differ, 1);
}

// Tests that answers are not judged while a change of gains is on its way or passes, and are again after it.
TEST(DeviceAnswersTest, ChangeOfGains) {
  const Judged judged = Replayed(RecordedRun(), 150);
  EXPECT_EQ(judged.not_judged, 200) << "limits.stale_input_s and limits.transfer_s of 0.1 s each";
  EXPECT_EQ(judged.differ, kTicks - 350) << "the record has the gains of before";
}

}  // namespace
}  // namespace hydro::hydro_log
