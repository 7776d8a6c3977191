// The device's safety: what gives zero volts, in which of its ticks, and what it takes to go on.
#include "firmware/device.h"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "tests/firmware/device_bench.h"

namespace hydro::firmware {
namespace {

using testing::BenchSettings;
using testing::DeviceBench;
using testing::kInfinity;

// Tests that a device puts out 0 V at the terminal after a reset, and 0 V of eq. (1) from the settings on.
TEST(DeviceTest, ZeroBeforeTheFirstCommand) {
  DeviceBench bench;
  EXPECT_EQ(bench.Tick(), 0);
  bench.Hello();
  EXPECT_EQ(bench.Tick(), 0);
  bench.Settings();
  EXPECT_FLOAT_EQ(bench.Tick(), 0.25F);
  bench.Send(bench.Voltage(3));  // not armed
  EXPECT_FLOAT_EQ(bench.Tick(), 0.25F);
  EXPECT_EQ(bench.sample.state, HYDRO_READY);
  bench.Arm();
  EXPECT_FLOAT_EQ(bench.Tick(), 0.25F);
  EXPECT_EQ(bench.sample.state, HYDRO_ARMED);
  EXPECT_EQ(bench.sample.command_age, UINT32_MAX);
}

// Tests that a command acts in the next tick, through the amplifier's scale, and is echoed with its age.
TEST(DeviceTest, ObeysACommand) {
  DeviceBench bench;
  bench.Armed();
  const hydro_frame command = bench.Voltage(3);
  bench.Send(command);
  EXPECT_FLOAT_EQ(bench.Tick(), -1.25F);  // (3 - 0.5) / -2
  EXPECT_EQ(bench.sample.source, HYDRO_SOURCE_VOLTAGE);
  EXPECT_EQ(bench.sample.voltage, 3);
  EXPECT_EQ(bench.sample.command_sequence, command.sequence);
  EXPECT_EQ(bench.sample.host_tick, command.body.command.host_tick);
  EXPECT_EQ(bench.sample.command_age, 0U);
  EXPECT_FLOAT_EQ(bench.Tick(), -1.25F);
  EXPECT_EQ(bench.sample.command_age, 1U);
}

// Tests that a command beyond the limit acts as the limit, and says so.
TEST(DeviceTest, VoltageIsLimited) {
  DeviceBench bench;
  bench.Armed();
  for (const float sign : {1.0F, -1.0F}) {
    bench.Send(bench.Voltage(sign * 8));
    bench.Tick();
    EXPECT_EQ(bench.sample.saturated, 0);
    bench.Send(bench.Voltage(sign * 1e30F));
    EXPECT_FLOAT_EQ(bench.Tick(), (sign * 8 - 0.5F) / -2);
    EXPECT_EQ(bench.sample.voltage, sign * 8);
    EXPECT_EQ(bench.sample.saturated, 1);
  }
}

// Tests that N ticks after the tick that took the last command the output is at zero, for several N: not one
// tick earlier, not one later.
TEST(DeviceTest, WatchdogCountsTicks) {
  for (const uint32_t n : {1U, 2U, 20U, 1000U}) {
    hydro_settings settings = BenchSettings();
    settings.watchdog_ticks = n;
    DeviceBench bench(settings);
    bench.Armed();
    bench.Send(bench.Voltage(3));
    for (uint32_t tick = 0; tick < n; ++tick) ASSERT_FLOAT_EQ(bench.Tick(), -1.25F) << n << ": tick " << tick;
    EXPECT_FLOAT_EQ(bench.Tick(), bench.Zero()) << n;
    EXPECT_EQ(bench.sample.state, HYDRO_TRIPPED);
    EXPECT_EQ(bench.sample.faults_latched, HYDRO_FAULT_WATCHDOG);
    EXPECT_EQ(bench.sample.trips, 1U);
  }
}

// Tests that arming without any command trips too, that missed ticks count, and that commands in time keep it
// armed.
TEST(DeviceTest, WatchdogFromArmingOn) {
  DeviceBench bench;
  bench.Armed();
  for (int tick = 0; tick < 20; ++tick) bench.Tick();
  EXPECT_EQ(bench.device.state, HYDRO_ARMED);
  bench.Tick();
  EXPECT_EQ(bench.device.state, HYDRO_TRIPPED);

  bench.Arm();
  bench.Send(bench.Voltage(3));
  bench.Tick();
  bench.readings.elapsed_ticks = 19;
  bench.Tick();
  EXPECT_EQ(bench.device.state, HYDRO_ARMED);
  bench.readings.elapsed_ticks = 1;
  bench.Tick();
  EXPECT_EQ(bench.device.state, HYDRO_TRIPPED);

  bench.Arm();
  for (int tick = 0; tick < 1000; ++tick) {
    if (tick % 20 == 0) bench.Send(bench.Voltage(3));
    ASSERT_FLOAT_EQ(bench.Tick(), -1.25F);
  }
}

// Tests that commands which waited while the board stood still do not excuse the ticks that it missed: it
// trips as it would have, and puts none of them out. One tick less, and it goes on.
TEST(DeviceTest, WatchdogAcrossAFreeze) {
  for (const uint32_t before : {0U, 15U}) {
    for (const uint32_t missed : {19U - before, 20U - before, 1000U}) {
      DeviceBench bench;
      bench.Armed();
      bench.Send(bench.Voltage(3));
      for (uint32_t tick = 0; tick <= before; ++tick) bench.Tick();
      bench.readings.elapsed_ticks = missed + 1;
      bench.Send(bench.Voltage(4));
      bench.Send(bench.Voltage(5));
      const bool trips = before + missed >= 20;
      EXPECT_FLOAT_EQ(bench.Tick(), trips ? bench.Zero() : -2.25F) << before << ", " << missed;
      EXPECT_EQ(bench.sample.state, trips ? HYDRO_TRIPPED : HYDRO_ARMED);
      EXPECT_EQ(bench.sample.faults_latched, trips ? HYDRO_FAULT_WATCHDOG : 0);
    }
  }
}

// Tests each cause: zero volts in the tick that finds it, the fault latched, no obedience afterwards, no
// re-arm while it is present, and obedience after a re-arm once it has gone.
TEST(DeviceTest, CausesOfZeroVolts) {
  struct Cause {
    const char* what;
    uint16_t fault;
    std::function<void(hydro_readings&)> change;
    int ticks = 1;  // until it acts
  };
  const std::vector<Cause> causes = {
      {"p1", HYDRO_FAULT_PRESSURE, [](auto& r) { r.analog_V[0] = 9.01F; }},
      {"p2", HYDRO_FAULT_PRESSURE, [](auto& r) { r.analog_V[1] = 9.01F; }},
      {"speed", HYDRO_FAULT_MOTOR_SPEED, [](auto& r) { r.counter[0] += 51; }},
      {"speed back", HYDRO_FAULT_MOTOR_SPEED, [](auto& r) { r.counter[0] -= 51; }},
      {"angle", HYDRO_FAULT_ARM_ANGLE, [](auto& r) { r.analog_V[2] = -1.51F; }},
      {"sensor", HYDRO_FAULT_SENSOR, [](auto& r) { r.analog_V[1] = -10; }},
      {"converters", HYDRO_FAULT_CONVERTER, [](auto& r) { r.answered = false; }},
      {"interlock", HYDRO_FAULT_INTERLOCK, [](auto& r) { r.interlock_closed = false; }},
      {"overrun", HYDRO_FAULT_OVERRUN, [](auto& r) { r.overrun = true; }},
      {"read-back", HYDRO_FAULT_READ_BACK, [](auto& r) { r.read_back_V = 4; }, 2},
  };
  for (const Cause& cause : causes) {
    SCOPED_TRACE(cause.what);
    hydro_settings settings = BenchSettings();
    settings.read_back_tolerance = 0.1F;
    DeviceBench bench(settings);
    bench.Armed();
    bench.Send(bench.Voltage(3));
    EXPECT_FLOAT_EQ(bench.Tick(), -1.25F);
    const hydro_readings good = bench.readings;
    for (int tick = 0; tick < cause.ticks; ++tick) {
      cause.change(bench.readings);
      bench.Send(bench.Voltage(3));
      EXPECT_FLOAT_EQ(bench.Tick(), tick + 1 < cause.ticks ? -1.25F : bench.Zero());
    }
    EXPECT_EQ(bench.sample.state, HYDRO_TRIPPED);
    EXPECT_EQ(bench.sample.faults_latched, cause.fault);
    EXPECT_EQ(bench.sample.faults_present, cause.fault);
    if (cause.fault != HYDRO_FAULT_OVERRUN) {
      bench.Arm();
      EXPECT_EQ(bench.device.state, HYDRO_TRIPPED) << "armed while the cause persists";
    }
    const uint32_t counted = bench.readings.counter[0];
    bench.readings = good;
    bench.readings.counter[0] = counted;
    for (int tick = 0; tick < 12; ++tick) {
      if (cause.fault == HYDRO_FAULT_READ_BACK) bench.readings.read_back_V = bench.device.written_volts;
      bench.Send(bench.Voltage(3));
      EXPECT_FLOAT_EQ(bench.Tick(), bench.Zero());
    }
    EXPECT_EQ(bench.sample.faults_present, 0);
    EXPECT_EQ(bench.sample.faults_latched, cause.fault);
    bench.Arm();
    EXPECT_EQ(bench.device.state, HYDRO_ARMED);
    bench.Send(bench.Voltage(3));
    EXPECT_FLOAT_EQ(bench.Tick(), -1.25F);
    EXPECT_EQ(bench.sample.faults_latched, 0);
  }
}

// Tests that a read-back that differs in one tick alone is the converter settling, and no fault.
TEST(DeviceTest, OneReadBackMayDiffer) {
  hydro_settings settings = BenchSettings();
  settings.read_back_tolerance = 0.1F;
  DeviceBench bench(settings);
  bench.Armed();
  for (int tick = 0; tick < 100; ++tick) {
    bench.Send(bench.Voltage(static_cast<float>(tick % 5)));
    const float before = bench.device.written_volts;
    bench.readings.read_back_V = tick % 2 == 0 ? before + 3 : before + 0.05F;
    bench.Tick();
  }
  EXPECT_EQ(bench.device.state, HYDRO_ARMED);
  EXPECT_NEAR(bench.sample.read_back, -2 * bench.readings.read_back_V + 0.5, 1e-5);
}

// Tests that commands which are no numbers, or beyond what dp_ref may be, trip; and dp_ref in remote I/O.
TEST(DeviceTest, CommandsThatAreNone) {
  const hydro_gains gains{0.1F, 1, 0, 0};
  struct Case {
    const char* what;
    uint8_t mode;
    std::function<hydro_frame(DeviceBench&)> make;
  };
  const std::vector<Case> cases = {
      {"NaN", HYDRO_REMOTE_IO, [](auto& b) { return b.Voltage(NAN); }},
      {"infinite", HYDRO_REMOTE_IO, [](auto& b) { return b.Voltage(-kInfinity); }},
      {"dp_ref NaN", HYDRO_LOOP_ON_DEVICE, [&](auto& b) { return b.Pressure(NAN, gains); }},
      {"dp_ref", HYDRO_LOOP_ON_DEVICE, [&](auto& b) { return b.Pressure(800.1F, gains); }},
      {"dp_ref down", HYDRO_LOOP_ON_DEVICE, [&](auto& b) { return b.Pressure(-800.1F, gains); }},
      {"gain", HYDRO_LOOP_ON_DEVICE,
       [](auto& b) {
         return b.Pressure(0, {0.1F, NAN, 0, 0});
       }},
      {"overflow", HYDRO_LOOP_ON_DEVICE,
       [](auto& b) {
         return b.Pressure(700, {3e38F, 0, 0, 0});
       }},
      {"dp_ref in remote I/O", HYDRO_REMOTE_IO, [&](auto& b) { return b.Pressure(0, gains); }},
  };
  for (const Case& each : cases) {
    SCOPED_TRACE(each.what);
    DeviceBench bench(BenchSettings(each.mode));
    bench.Armed();
    bench.Send(bench.Voltage(3));
    EXPECT_FLOAT_EQ(bench.Tick(), -1.25F);
    bench.Send(each.make(bench));
    EXPECT_FLOAT_EQ(bench.Tick(), bench.Zero());
    EXPECT_EQ(bench.sample.state, HYDRO_TRIPPED);
    EXPECT_EQ(bench.sample.faults_latched, HYDRO_FAULT_COMMAND);
    EXPECT_EQ(bench.sample.voltage, 0);
    bench.Arm();
    bench.Send(bench.Voltage(3));
    EXPECT_FLOAT_EQ(bench.Tick(), -1.25F);
  }
}

// Tests that in any sequence of frames, readings and missed ticks the output is at zero unless the device is
// armed, and never beyond its limit: 300000 random ticks, most of them on devices that are armed again and
// again.
TEST(DeviceTest, NeverDrivesUnasked) {
  std::mt19937 random(11);
  int armed = 0, driving = 0;
  for (int run = 0; run < 300; ++run) {
    DeviceBench bench(BenchSettings(random() % 2 == 0 ? HYDRO_REMOTE_IO : HYDRO_LOOP_ON_DEVICE));
    bench.Hello();
    for (int tick = 0; tick < 1000; ++tick) {
      switch (random() % 24) {
        case 0:
          bench.Hello();
          break;
        case 1:
          bench.Settings();
          break;
        case 2:
        case 3:
          bench.Arm();
          break;
        case 4:
          if (random() % 8 == 0) bench.Send(bench.Frame(HYDRO_ZERO));
          break;
        case 5:
          if (random() % 8 == 0) bench.Send(testing::AnyFrame(testing::kKinds[random() % 11], random));
          break;
        case 6:
          bench.readings.analog_V[random() % 3] = static_cast<float>(random() % 100) / 10 - 0.5F;
          break;
        case 7:
          bench.readings.answered = random() % 8 != 0;
          break;
        case 8:
          bench.readings.analog_V[0] = bench.readings.analog_V[1] = bench.readings.analog_V[2] = 1;
          break;
        case 9:
          bench.Send(bench.Pressure(static_cast<float>(random() % 810), {0.1F, 1, 0.01F, 2}));
          break;
        case 10:
        case 11:
        case 12:
          bench.Send(bench.Voltage(static_cast<float>(random() % 40) - 20));
          break;
        default:
          break;
      }
      bench.readings.elapsed_ticks = random() % 100 == 0 ? 3 : 1;
      const float volts = bench.Tick();
      const bool is_zero = volts == bench.device.zero_volts;
      ASSERT_TRUE(bench.device.state == HYDRO_ARMED || is_zero) << run << ", " << tick;
      ASSERT_LE(std::fabs(-2 * volts + 0.5F), 8.0001F);
      if (bench.device.state == HYDRO_ARMED) ++armed;
      if (!is_zero) ++driving;
    }
  }
  EXPECT_GT(armed, 10000);
  EXPECT_GT(driving, 5000);
}

}  // namespace
}  // namespace hydro::firmware
