// The pressure loop on the device: what the rig passes on, and what comes back.
#include <gmock/gmock.h>

#include <functional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "tests/plant/front_end/device_bench.h"

namespace hydro::plant {
namespace {

using pressure_ctrl::PressureLawSettings;
using Answer = pressure_ctrl::DeviceLoop::Answer;

PressureLawSettings Law(double k_p) {
  PressureLawSettings law;
  law.gains = {.k_p = k_p, .k_v = 0.5};
  law.voltage_limit = 10;
  law.reference_feedforward = 0.002;
  return law;
}

class LoopOnDeviceTest : public ::testing::Test {
 protected:
  LoopOnDeviceTest()
      : bench(settings::Replaced(kFrontEndText, "watchdog_s = 0.05",
                                 "watchdog_s = 0.05\nmode = \"loop_on_device\"")) {
    bench.readings.analog_V[1] = 0.35F;  // p2 - p1 = 50
    EXPECT_TRUE(bench.Connect());
  }

  // A tick in which the application follows `reference`, as PressureApp does between two ticks of the plant.
  Answer Follow(double reference, const PressureLawSettings& law) {
    bench.measured = bench.rig->Read(++bench.tick);
    bench.rig->Obey(bench.rig->faults().empty() ? bench.tick : -1);
    bench.rig->Drive(answer.voltage);
    answer = bench.rig->Follow(state_t{}, reference, law);
    bench.RunDevice();
    bench.Wait();
    return answer;
  }

  DeviceBench bench;
  Answer answer;
};

// Tests that the device acts by eq. (16) with the reference and gains that it is sent, once it is armed, and
// that its answers are what it has put out for the very state that was read.
TEST_F(LoopOnDeviceTest, AnswersEachState) {
  EXPECT_EQ(bench.device.settings.mode, HYDRO_LOOP_ON_DEVICE);
  EXPECT_FALSE(Follow(100, Law(0.02)).by_law) << "not armed";
  for (int i = 0; i < 10; ++i) Follow(100, Law(0.02));
  EXPECT_TRUE(answer.by_law);
  EXPECT_EQ(answer.pressure_ref, 100);
  EXPECT_FLOAT_EQ(static_cast<float>(answer.voltage), 0.02F * (100 - 50) + 0.002F * 100);
  EXPECT_FALSE(answer.saturated);
  for (int i = 0; i < 10; ++i) Follow(700, Law(0.02));
  EXPECT_EQ(answer.voltage, 8) << "limit_V";
  EXPECT_TRUE(answer.saturated);
  EXPECT_EQ(bench.rig->Drive(answer.voltage), 8) << "what acts is what the device says";
}

// Tests that other gains let the voltage where it was, and that the difference then passes in a straight
// line.
TEST_F(LoopOnDeviceTest, GainsChangeWithoutAJump) {
  for (int i = 0; i < 10; ++i) Follow(100, Law(0.02));
  const double before = answer.voltage, after = 0.04 * 50 + 0.2;
  std::vector<double> voltages;
  for (int i = 0; i < 110; ++i) voltages.push_back(Follow(100, Law(0.04)).voltage);
  for (size_t i = 1; i < voltages.size(); ++i) {
    EXPECT_LE(std::fabs(voltages[i] - voltages[i - 1]), 1.01 * (after - before) / 100) << i;
  }
  EXPECT_NEAR(voltages[1], before, 0.03 * (after - before));
  EXPECT_NEAR(voltages[50], (before + after) / 2, 0.03 * (after - before));
  EXPECT_NEAR(voltages.back(), after, 1e-6);
}

// Tests that a voltage is put out where the application follows nothing, and zero where nothing may be
// obeyed.
TEST_F(LoopOnDeviceTest, ReleaseAndHold) {
  for (int i = 0; i < 10; ++i) Follow(100, Law(0.02));
  ASSERT_EQ(bench.device.sample.source, HYDRO_SOURCE_LAW);
  bench.rig->Release();
  bench.Ticks(3, 2.5);
  EXPECT_EQ(bench.device.sample.source, HYDRO_SOURCE_VOLTAGE);
  EXPECT_EQ(bench.device.sample.voltage, 2.5F);
  for (int i = 0; i < 3; ++i) Follow(100, Law(0.02));
  ASSERT_EQ(bench.device.sample.source, HYDRO_SOURCE_LAW);
  for (int i = 0; i < 3; ++i) {
    bench.Tick(1, /*obeys=*/false);
    EXPECT_FALSE(bench.rig->Follow(state_t{}, 100, Law(0.02)).by_law);
    EXPECT_EQ(bench.volts, 0) << "the hold is stronger than the loop";
  }
}

// Tests that swings of the device's loop between two samples, and samples that are lost, do not make its
// output look wrong, and that one which is stuck is found in spite of both, within limits.stale_input_s.
TEST_F(LoopOnDeviceTest, ReadBackOfWhatNoSampleShows) {
  for (const double lost : {0.0, 0.5}) {
    bench.to_computer = Wire({.lost_frame = lost}, 36);
    std::mt19937 random(36);
    bool swings = false;
    bench.before_tick = [&](uint64_t) {
      const bool sampled = bench.device.sample_in_ticks <= 1;
      bench.readings.analog_V[1] = swings && !sampled ? 0.95F : 0.35F;  // 6 V less
      if (sampled) swings = std::bernoulli_distribution(0.5)(random);
      bench.readings.read_back_V = bench.device.written_volts;
    };
    for (int i = 0; i < 2000; ++i) {
      Follow(100, Law(0.02));
      ASSERT_EQ(bench.Fault("output_differs"), "") << i << " " << lost;
    }
    EXPECT_TRUE(answer.by_law);
    bench.before_tick = [&](uint64_t) { bench.readings.read_back_V = 4; };
    int ticks = 0;
    for (; bench.Fault("output_differs").empty() && ticks < 1000; ++ticks) Follow(100, Law(0.02));
    EXPECT_LE(ticks, 1.1 * 1000 * bench.config.limits.stale_input_s) << lost;
    bench.before_tick = [&](uint64_t) { bench.readings.read_back_V = bench.device.written_volts; };
    for (int i = 0; i < 300; ++i) Follow(100, Law(0.02));
  }
}

// Tests that a reference beyond what the configuration allows stops the device.
TEST_F(LoopOnDeviceTest, ReferenceLimit) {
  for (int i = 0; i < 10; ++i) Follow(100, Law(0.02));
  const double limit = bench.device.settings.reference_limit;
  bench.device.settings.reference_limit = 90;  // as if it had a limit of its own
  for (int i = 0; i < 3; ++i) Follow(100, Law(0.02));
  EXPECT_EQ(bench.volts, 0);
  EXPECT_GT(limit, 90);
}

// Tests that a device whose voltage is not that of eq. (16) for its own readings is at fault in the very
// sample, with an arm that stands still (all readings are constant here) as with one that moves: by its gain,
// its sign, a reference or a change of gains of its own invention.
TEST_F(LoopOnDeviceTest, ALawThatLies) {
  using Lie = std::function<void(hydro_sample&)>;
  const std::vector<std::pair<Lie, std::string>> lies = {
      {[](hydro_sample& s) { s.voltage = 1.02F * s.voltage; }, "puts out 1.224 V; eq. (16) gives 1.2 V"},
      {[](hydro_sample& s) { s.voltage = -s.voltage; }, "puts out -1.2 V; eq. (16) gives 1.2 V"},
      {[](hydro_sample& s) { s.voltage = 0; }, "puts out 0 V; eq. (16) gives 1.2 V"},
      {[](hydro_sample& s) { s.voltage = NAN; }, "eq. (16) gives 1.2 V"},
      {[](hydro_sample& s) { s.voltage = 1.5F, s.saturated = 1; }, "puts out 1.5 V; eq. (16) gives 1.2 V"},
      {[](hydro_sample& s) { s.voltage = 0.3F, s.saturated = 1; }, "puts out 0.3 V; eq. (16) gives 1.2 V"},
      {[](hydro_sample& s) { s.saturated = 1; },
       "reduce its voltage (saturated is 1); it was asked for 1.2 V"},
      {[](hydro_sample& s) { s.value[HYDRO_P2] += 10; }, "puts out 1.2 V; eq. (16) gives 1 V"},
      {[](hydro_sample& s) { s.pressure_ref = 110, s.voltage = 1.42F; },
       "a reference of 110; it was told 100"},
      {[](hydro_sample& s) { s.transfer = 3, s.voltage += 3; },
       "adds 3 V to eq. (16) for a change of its gains"}};
  for (const bool moves : {false, true}) {
    bench.before_tick = [&](uint64_t tick) {
      if (moves) bench.readings.counter[0] = static_cast<uint32_t>(tick / 50);
    };
    for (const auto& [lie, words] : lies) {
      bench.lie = nullptr;
      for (int i = 0; i < 150; ++i) Follow(100, Law(0.02));
      ASSERT_TRUE(bench.rig->faults().empty()) << words << ": " << bench.rig->faults().front().text;
      bench.lie = lie;
      for (int i = 0; i < 2; ++i) Follow(100, Law(0.02));
      EXPECT_NE(bench.Fault("output_differs"), "") << words;
      if (!moves) {
        EXPECT_THAT(bench.Fault("output_differs"), ::testing::HasSubstr(words));
      }
      EXPECT_EQ(bench.volts, 0) << "it was told zero";
    }
  }
}

// Tests that a device that goes on by its law where it is told zero volts is at fault, and that what it puts
// out is then no motor command's.
TEST_F(LoopOnDeviceTest, ALawThatDoesNotEnd) {
  for (int i = 0; i < 20; ++i) Follow(100, Law(0.02));
  const hydro_sample last = bench.device.sample;
  ASSERT_EQ(last.source, HYDRO_SOURCE_LAW);
  bench.lie = [&](hydro_sample& s) {
    s.state = HYDRO_ARMED;
    s.source = HYDRO_SOURCE_LAW;
    s.command_sequence = last.command_sequence;
    s.pressure_ref = last.pressure_ref;
    s.voltage = last.voltage;
  };
  bench.rig->Release();
  bench.Ticks(150, 0);
  EXPECT_THAT(bench.Fault("output_differs"), ::testing::HasSubstr("puts out 1.2 V; it was told 0 V"));
  EXPECT_EQ(bench.rig->acting_command_tick(), -1);
}

// Tests that a change of gains explains no more than it can: 5 V for a hundredth of the gain is a lie, as
// soon as it passes, also while another change passes.
TEST_F(LoopOnDeviceTest, AChangeOfGainsExplainsLittle) {
  for (const int changes : {1, 2}) {
    bench.lie = nullptr;
    for (int i = 0; i < 400; ++i) Follow(100, Law(0.02));
    ASSERT_TRUE(bench.rig->faults().empty()) << bench.rig->faults().front().text;
    for (int change = 0; change < changes; ++change) Follow(100, Law(change % 2 == 0 ? 0.0202 : 0.0204));
    bench.lie = [](hydro_sample& s) { s.transfer = 5, s.voltage += 5; };
    for (int i = 0; i < 2; ++i) Follow(100, Law(changes == 1 ? 0.0202 : 0.0204));
    EXPECT_THAT(bench.Fault("output_differs"), ::testing::HasSubstr("theirs explains at most 0."));
    EXPECT_EQ(bench.volts, 0);
  }
}

// Tests that what a change of gains adds is no lie while it passes.
TEST_F(LoopOnDeviceTest, AChangeOfGainsIsNoLie) {
  for (int i = 0; i < 20; ++i) Follow(100, Law(0.02));
  for (int change = 0; change < 4; ++change) {
    for (int i = 0; i < 40; ++i) {
      Follow(100 + i, Law(change % 2 == 0 ? 0.04 : 0.02));
      ASSERT_TRUE(bench.rig->faults().empty()) << bench.rig->faults().front().text;
    }
  }
}

}  // namespace
}  // namespace hydro::plant
