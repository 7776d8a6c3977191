// The loop on the device: eq. (16) from the device's own sensors, and changes of its gains.
#include <gtest/gtest.h>

#include "pressure_ctrl/law/pressure_law.h"
#include "tests/firmware/device_bench.h"

namespace hydro::firmware {
namespace {

using testing::BenchSettings;
using testing::DeviceBench;

class DeviceLoopTest : public ::testing::Test {
 protected:
  static hydro_settings Settings() {
    hydro_settings settings = BenchSettings(HYDRO_LOOP_ON_DEVICE);
    settings.transfer_ticks = 100;
    return settings;
  }
  float Tick(float reference, const hydro_gains& gains) {
    bench_.Send(bench_.Pressure(reference, gains));
    bench_.Tick();
    return bench_.sample.voltage;
  }

  DeviceBench bench_{Settings()};
};

// Tests that the voltage of each tick is what the computer's law gives for the sample of that tick,
// saturation included.
TEST_F(DeviceLoopTest, VoltageIsThatOfTheComputersLaw) {
  bench_.Armed();
  std::mt19937 random(2);
  int saturated = 0;
  for (int tick = 0; tick < 5000; ++tick) {
    bench_.readings.analog_V[0] = static_cast<float>(random() % 8000) / 1000;
    bench_.readings.analog_V[1] = static_cast<float>(random() % 8000) / 1000;
    bench_.readings.counter[0] += random() % 90 - 45;
    const float voltage = Tick(static_cast<float>(random() % 1600) - 800, {0.02F, 0.3F, 0.003F, 0});
    const hydro_sample& sample = bench_.sample;
    ASSERT_EQ(sample.source, HYDRO_SOURCE_LAW);
    pressure_ctrl::PressureLawSettings settings;
    settings.gains = {0.02F, 0.3F};
    settings.reference_feedforward = 0.003F;
    settings.voltage_limit = 8;
    const pressure_ctrl::PressureLawOutput expected = pressure_ctrl::PressureLaw(
        settings, {sample.pressure_ref, sample.value[HYDRO_P1], sample.value[HYDRO_P2],
                   sample.value[HYDRO_MOTOR_SPEED], sample.value[HYDRO_ARM_SPEED], sample.transfer});
    ASSERT_NEAR(voltage, expected.voltage, 1e-4);
    saturated += sample.saturated;
  }
  EXPECT_GT(saturated, 500);
  EXPECT_LT(saturated, 4500);
}

// Tests that a change of gains leaves the voltage where it was in its tick, and that it then goes to the new
// law's in even steps; and that a second change on the way does not make it jump either.
TEST_F(DeviceLoopTest, ChangeOfGainsIsBumpless) {
  bench_.Armed();
  const hydro_gains before{0.01F, 0, 0, 0}, after{0.02F, 0, 0, 0}, last{0.005F, 0, 0, 0};
  EXPECT_FLOAT_EQ(Tick(200, before), 2);
  EXPECT_FLOAT_EQ(Tick(200, after), 2);
  EXPECT_FLOAT_EQ(bench_.sample.transfer, -2);
  float voltage = 2;
  for (int tick = 1; tick <= 50; ++tick) {
    const float next = Tick(200, after);
    EXPECT_NEAR(next - voltage, 0.02, 1e-5);
    voltage = next;
  }
  EXPECT_NEAR(Tick(200, last), 3.02, 1e-5);  // one step further, by the law it had
  for (int tick = 1; tick < 100; ++tick) Tick(200, last);
  EXPECT_GT(bench_.sample.transfer, 0);
  EXPECT_FLOAT_EQ(Tick(200, last), 1);
  EXPECT_EQ(bench_.sample.transfer, 0);
}

// Tests that there is no transfer from a voltage that was not the law's: after arming, and after a voltage
// passed on.
TEST_F(DeviceLoopTest, NoTransferFromElsewhere) {
  bench_.Armed();
  bench_.Tick();
  EXPECT_FLOAT_EQ(Tick(200, {0.01F, 0, 0, 0}), 2);
  bench_.Send(bench_.Voltage(-5));
  bench_.Tick();
  EXPECT_EQ(bench_.sample.source, HYDRO_SOURCE_VOLTAGE);
  EXPECT_EQ(bench_.sample.voltage, -5);
  EXPECT_EQ(bench_.sample.pressure_ref, 0);
  EXPECT_FLOAT_EQ(Tick(200, {0.02F, 0, 0, 0}), 4);
  EXPECT_EQ(bench_.sample.transfer, 0);
}

// Tests that the law acts in every tick between commands, on what the sensors then read.
TEST_F(DeviceLoopTest, ActsBetweenCommands) {
  bench_.Armed();
  EXPECT_FLOAT_EQ(Tick(200, {0.01F, 0, 0, 0}), 2);
  bench_.readings.analog_V[1] = 2;  // dp 100
  bench_.Tick();
  EXPECT_FLOAT_EQ(bench_.sample.voltage, 1);
  EXPECT_EQ(bench_.sample.command_age, 1U);
}

// Tests that the arm's speed counts with a ratio, and that a ratio without an arm's speed gives zero volts.
TEST_F(DeviceLoopTest, ArmSpeed) {
  bench_.Armed();
  Tick(0, {0.01F, 10, 0, 2});
  bench_.readings.analog_V[2] += 0.005F;  // 5 rad/s
  EXPECT_NEAR(Tick(0, {0.01F, 10, 0, 2}), 1, 1e-4);
  DeviceBench without(Settings());
  without.settings.sensors[HYDRO_ARM_SPEED] = {};
  without.Armed();
  without.Send(without.Pressure(200, {0.01F, 10, 0, 2}));
  EXPECT_FLOAT_EQ(without.Tick(), without.Zero());
  EXPECT_EQ(without.sample.faults_latched, HYDRO_FAULT_COMMAND);
}

}  // namespace
}  // namespace hydro::firmware
