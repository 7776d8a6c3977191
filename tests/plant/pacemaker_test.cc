// A rig that samples by a clock of its own: how long a command takes to get there, and what the states say of
// it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <hydro/state_t.hpp>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tests/plant/run_plant.h"
#include "tests/stack_fixture.h"

namespace hydro::plant {
namespace {

using namespace std::chrono_literals;
using testing::SmallStack;

constexpr auto kPhase = 300us;  // of the device's samples, which come every millisecond

// Goes on with each sample, like a bus that wakes on the rig's descriptor.
class WakingBus : public bus::InProcessBus {
 public:
  explicit WakingBus(bus::SimulatedClock& clock) : InProcessBus(&clock), clock_(clock) {}
  int HandleUntil(TimePoint deadline) override {
    const auto sample =
        bus::Clock::TimePoint(kPhase + 1ms * ((clock_.Now().time_since_epoch() + 1ms - kPhase) / 1ms));
    return InProcessBus::HandleUntil(std::min(deadline, sample));
  }

 private:
  bus::SimulatedClock& clock_;
};

// Puts out, with each sample, what it was told before.
class PacedRig : public Rig, public Pacemaker {
 public:
  explicit PacedRig(bus::SimulatedClock& clock) : clock_(clock) {}

  std::string role() const override { return "driver"; }
  model::Measurement Read(int64_t tick) override {
    tick_ = tick;
    read_ = newest_;
    if (on_read) on_read(tick);
    model::Measurement measured;
    measured.p1 = measured.p2 = 100;
    return measured;
  }
  const std::vector<RigFault>& faults() const override { return faults_now; }
  double Drive(double voltage) override {
    driven[tick_].push_back(voltage);
    told_ = {voltage, command_tick_};
    return read_.first;
  }
  void Obey(int64_t command_tick) override { command_tick_ = command_tick; }
  OutputLeft Zero() noexcept override { return {}; }

  Pacemaker* pacemaker() override { return this; }
  std::optional<int64_t> Arrived() override {
    const auto number = static_cast<int64_t>((clock_.Now().time_since_epoch() - kPhase) / 1ms);
    if (silent || number == number_) return std::nullopt;
    newest_ = told_;
    number_ = number;
    return number;
  }
  int descriptor() const override { return -1; }
  int64_t acting_command_tick() const override { return read_.second; }

  std::function<void(int64_t)> on_read;
  std::vector<RigFault> faults_now;
  std::map<int64_t, std::vector<double>> driven;  // by tick
  bool silent = false;

 private:
  using PutOut = std::pair<double, int64_t>;  // voltage, tick of its command
  bus::SimulatedClock& clock_;
  int64_t number_ = 0, tick_ = 0, command_tick_ = -1;
  PutOut told_{0, -1}, newest_{0, -1}, read_{0, -1};
};

class PacemakerTest : public ::testing::Test {
 protected:
  PacemakerTest() {
    config_.time.mode = settings::TimeMode::kRealtime;
    bus_.Subscribe<state_t>("HYDRO_STATE", [this](const state_t& s) {
      states_.push_back(s);
      motor_command_t command{};
      command.tick = s.tick;
      command.session = 1;
      command.sequence = s.tick;
      command.voltage = 0.01 * static_cast<double>(s.tick);
      if (answers_) bus_.Publish("HYDRO_MOTOR_COMMAND", command);
    });
    bus_.Subscribe<fault_t>("HYDRO_FAULT", [this](const fault_t& f) { faults_.push_back(f.code); });
  }
  int Run() { return RunPlant(bus_, clock_, config_, rig_).exit_code; }

  bus::SimulatedClock clock_;
  WakingBus bus_{clock_};
  settings::StackConfig config_ = SmallStack();
  PacedRig rig_{clock_};
  bool answers_ = true;
  std::vector<state_t> states_;
  std::vector<std::string> faults_;
};

// Tests that the answer to each sample is out before the next one, so that it acts a tick later, as that of a
// board in the computer does, and that each state says what the device has put out and which command that
// came from.
TEST_F(PacemakerTest, AnAnswerActsFromTheNextSampleOn) {
  EXPECT_EQ(Run(), 0);
  ASSERT_EQ(states_.size(), 101u);
  for (int64_t k = 0; k < 100; ++k) {
    EXPECT_EQ(states_[k].tick, k);
    EXPECT_EQ(states_[k].skipped_ticks, 0);
    EXPECT_THAT(rig_.driven[k], ::testing::ElementsAre(0.01 * static_cast<double>(k))) << "once in each tick";
    if (k < 3) continue;
    EXPECT_EQ(states_[k].command_tick, k - 2) << "acted from the tick before this one on";
    EXPECT_EQ(states_[k].voltage, 0.01 * static_cast<double>(k - 2));
  }
  EXPECT_TRUE(faults_.empty());
}

// Tests that a fault of the rig gives zero volts in the tick in which it is read, and no answer is waited
// for.
TEST_F(PacemakerTest, FaultsDoNotWait) {
  rig_.on_read = [this](int64_t tick) {
    rig_.faults_now.clear();
    if (tick >= 20 && tick < 40) rig_.faults_now.push_back({"sensor_p1", "p1 is gone", 1, 2});
  };
  EXPECT_EQ(Run(), 0);
  for (int64_t k = 1; k < 100; ++k) {
    const double expected = k >= 20 && k < 40 ? 0 : 0.01 * static_cast<double>(k);
    EXPECT_THAT(rig_.driven[k], ::testing::ElementsAre(expected)) << k;
  }
  EXPECT_THAT(faults_, ::testing::ElementsAre("sensor_p1", "sensor_p1")) << "begins and ends";
}

// Tests that a loop which answers no more leaves its last command there until it is stale, told to the device
// in each tick, and that its first answer acts at once.
TEST_F(PacemakerTest, RepeatsWithoutAnAnswer) {
  config_.limits.stale_input_s = 0.01;
  bus_.Subscribe<state_t>("HYDRO_STATE",
                          [this](const state_t& s) { answers_ = s.tick < 30 || s.tick >= 60; });
  EXPECT_EQ(Run(), 0);
  for (int64_t k = 32; k < 40; ++k)
    EXPECT_THAT(rig_.driven[k], ::testing::ElementsAre(rig_.driven[31][0])) << k;
  EXPECT_GT(rig_.driven[31][0], 0);
  for (int64_t k = 43; k < 60; ++k) EXPECT_THAT(rig_.driven[k], ::testing::ElementsAre(0)) << k;
  EXPECT_EQ(rig_.driven[63][0], 0.63);
  EXPECT_THAT(faults_, ::testing::Contains("stale_motor_command"));
}

// Tests that ticks go on by the computer's clock while the device is silent.
TEST_F(PacemakerTest, GoesOnWithoutTheDevice) {
  rig_.on_read = [this](int64_t tick) { rig_.silent = tick >= 20 && tick < 50; };
  EXPECT_EQ(Run(), 0);
  EXPECT_EQ(states_.size(), 101u);
  EXPECT_NEAR(bus::ToSeconds(clock_.Now().time_since_epoch()), 0.1, 0.002);
}

}  // namespace
}  // namespace hydro::plant
