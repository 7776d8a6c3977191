#include "plant/front_end/front_end_rig.h"

#include <gmock/gmock.h>

#include "tests/plant/front_end/device_bench.h"

namespace hydro::plant {
namespace {

using ::testing::HasSubstr;

// Tests the way from the first byte to the first volt: the device holds the configuration's settings, stays
// at zero until something is obeyed, and then does what it is told, within the limit.
TEST(FrontEndRigTest, FromTheFirstByteToTheFirstVolt) {
  DeviceBench bench;
  ASSERT_TRUE(bench.Connect());
  EXPECT_EQ(bench.rig->Describe(), "udp://127.0.0.1:7 (bench, firmware 1.0.0, 5000 ticks/s)");
  const hydro_settings& held = bench.device.settings;
  EXPECT_EQ(held.mode, HYDRO_REMOTE_IO);
  EXPECT_EQ(held.sample_interval_ticks, 5);
  EXPECT_EQ(held.watchdog_ticks, 250U);
  EXPECT_EQ(held.voltage_limit, 8);
  EXPECT_EQ(held.pressure_limit, 2000);
  EXPECT_EQ(held.output_scale, -2);
  EXPECT_TRUE(std::isinf(held.motor_speed_limit));
  EXPECT_FLOAT_EQ(held.arm_angle_limit, static_cast<float>(bench.config.limits.arm_angle_rad));
  EXPECT_EQ(held.sensors[HYDRO_MOTOR_ANGLE].counter_bits, 16);
  EXPECT_EQ(held.sensors[HYDRO_MOTOR_SPEED].kind, HYDRO_SENSOR_RATE);
  EXPECT_EQ(held.sensors[HYDRO_ARM_SPEED].kind, HYDRO_SENSOR_NONE);

  for (int i = 0; i < 400; ++i) EXPECT_EQ(bench.Tick(3, /*obeys=*/false), 0);
  EXPECT_EQ(bench.device.state, HYDRO_READY)
      << "nobody has asked for volts, and the session is kept all the same";
  EXPECT_EQ(bench.device.session, 0x1234U);
  EXPECT_EQ(bench.Tick(3), 0) << "it is not armed yet";
  bench.Ticks(5, 3);
  EXPECT_EQ(bench.Tick(3), 3);
  EXPECT_EQ(bench.device.state, HYDRO_ARMED);
  EXPECT_FLOAT_EQ(bench.volts, -1.5) << "at the terminal";
  EXPECT_EQ(bench.Tick(11), 3) << "still, when this one leaves";
  EXPECT_EQ(bench.rig->acting_command_tick(), bench.tick - 2) << "the one before has arrived";
  EXPECT_EQ(bench.Tick(-11), 8) << "limit_V";
  EXPECT_EQ(bench.volts, 4);
  EXPECT_EQ(bench.Tick(NAN), -8);
  EXPECT_EQ(bench.volts, 0);
  bench.Tick(1, /*obeys=*/false);
  bench.Tick(1, /*obeys=*/false);
  EXPECT_EQ(bench.rig->acting_command_tick(), -1) << "zero is nobody's command";
  EXPECT_TRUE(bench.rig->faults().empty());
  EXPECT_EQ(bench.rig->lost_messages(), 0);
}

// Tests that signals come in the model's units, and that an angle from a counter stays exact where one in
// single precision does not, beyond its wraps.
TEST(FrontEndRigTest, Signals) {
  DeviceBench bench;
  bench.readings.analog_V[0] = 0.5;
  bench.readings.analog_V[1] = 1;
  bench.readings.analog_V[2] = -0.5;
  uint32_t count = 0;
  bench.before_tick = [&](uint64_t) { bench.readings.counter[0] = (count += 7) & 0xffff; };
  ASSERT_TRUE(bench.Connect());
  bench.Ticks(2000, 1);
  EXPECT_EQ(bench.measured.p1, 250);
  EXPECT_EQ(bench.measured.p2, 500);
  EXPECT_FLOAT_EQ(static_cast<float>(bench.measured.arm_angle), -0.1F);
  EXPECT_TRUE(std::isnan(bench.measured.arm_speed));
  EXPECT_FLOAT_EQ(static_cast<float>(bench.measured.motor_speed), 35)
      << "7 counts of 0.001 rad, 5000 times a second";
  EXPECT_GT(count, 65536U);
  const double counts = bench.measured.motor_angle / 0.001;
  EXPECT_NEAR(counts, std::round(counts), 1e-6);
  EXPECT_EQ(static_cast<uint32_t>(std::llround(counts)), count - 7 * 9)
      << "the first of the five ticks of the sample before";
}

// Tests that the count goes on beyond 2^31 in both directions.
TEST(FrontEndRigTest, CountWithoutAnEnd) {
  DeviceCount count;
  EXPECT_EQ(count.Update(-5), -5);
  EXPECT_EQ(count.Update(2147483647), 2147483647LL - 4294967296LL) << "the nearer of the two ways";
  DeviceCount up;
  EXPECT_EQ(up.Update(2147483600), 2147483600);
  EXPECT_EQ(up.Update(-2147483600), 2147483696LL);
  EXPECT_EQ(up.Update(2147483600), 2147483600);
}

// Tests that a pulled cable is a fault at once, that the device goes to zero by itself after exactly its own
// limit, and that with the cable back it waits for a command that is obeyed.
TEST(FrontEndRigTest, PulledCable) {
  DeviceBench bench;
  ASSERT_TRUE(bench.Connect());
  bench.Ticks(20, 3);
  ASSERT_EQ(bench.volts, -1.5);
  bench.link->Unplug();
  bench.measured = bench.rig->Read(++bench.tick);
  EXPECT_THAT(bench.Fault("device_silent"), HasSubstr("the link to udp://127.0.0.1:7 is cut"));
  EXPECT_TRUE(std::isnan(bench.measured.p1));
  int ticks = 0;
  bench.before_tick = [&](uint64_t) { ticks += bench.device.state == HYDRO_ARMED; };
  for (int i = 0; i < 60; ++i) EXPECT_EQ(bench.Tick(3), 0);
  EXPECT_EQ(bench.volts, 0);
  EXPECT_EQ(bench.device.state, HYDRO_TRIPPED);
  // The last command was taken in the last tick before; 250 ticks later the watchdog trips, in the tick that
  // it is counted in.
  EXPECT_NEAR(ticks, 250, DeviceBench::kTicks);
  bench.link->plugged = true;
  bool tripped = false;
  for (int i = 0; i < 300 && bench.device.state != HYDRO_ARMED; ++i) {
    bench.Tick(3, /*obeys=*/i > 250);
    tripped =
        tripped || bench.Fault("device_fault").find("driver.watchdog_s (watchdog)") != std::string::npos;
    if (i == 250) {
      EXPECT_EQ(bench.device.state, HYDRO_TRIPPED) << "nobody has asked";
    }
  }
  EXPECT_TRUE(tripped);
  bench.Ticks(5, 3);
  EXPECT_EQ(bench.volts, -1.5);
}

// Tests that a device that stops sending, its link open, is a fault within the stale limit and not before.
TEST(FrontEndRigTest, SilentDevice) {
  DeviceBench bench;
  ASSERT_TRUE(bench.Connect());
  bench.Ticks(20, 3);
  bench.device_runs = false;
  int ticks = 0;
  for (; ticks < 500 && bench.rig->faults().empty(); ++ticks) bench.Tick(3);
  EXPECT_NEAR(ticks, 101, 2) << "limits.stale_input_s = 0.1";
  EXPECT_THAT(bench.Fault("device_silent"),
              HasSubstr("no sample from udp://127.0.0.1:7 for 101 ms, allowed are 100 ms"));
  EXPECT_TRUE(std::isnan(bench.measured.motor_speed));
  bench.device_runs = true;
  bench.Ticks(200, 3);
  EXPECT_TRUE(bench.rig->faults().empty());
  EXPECT_EQ(bench.volts, -1.5);
}

// Tests that a reset is noticed, however short, and that the device gets its settings anew before it may
// drive.
TEST(FrontEndRigTest, Reset) {
  DeviceBench bench;
  ASSERT_TRUE(bench.Connect());
  bench.Ticks(20, 3);
  bench.Reset();
  EXPECT_EQ(bench.device.fingerprint, 0U);
  std::string fault;
  for (int i = 0; i < 90 && fault.empty(); ++i) {
    bench.Tick(3);
    fault = bench.Fault("device_fault");
    EXPECT_EQ(bench.volts, 0);
  }
  EXPECT_THAT(fault, HasSubstr("has reset itself"));
  for (int i = 0; i < 100; ++i) bench.Tick(3, /*obeys=*/false);
  EXPECT_EQ(bench.device.state, HYDRO_READY);
  EXPECT_NE(bench.device.fingerprint, 0U);
  EXPECT_TRUE(bench.rig->faults().empty());
  bench.Ticks(20, 3);
  EXPECT_EQ(bench.volts, -1.5);
}

// Tests that what trips the device is reported by name.
TEST(FrontEndRigTest, FaultsOfTheDevice) {
  DeviceBench bench(std::string(kFrontEndText) + "[limits]\nmotor_speed = 100\n");
  ASSERT_TRUE(bench.Connect());
  bench.Ticks(20, 3);
  bench.readings.analog_V[0] = 4.1F;  // 2050 psi
  bench.Ticks(2, 3);
  EXPECT_THAT(bench.Fault("device_fault"),
              HasSubstr("put out zero volts by itself: p1 or p2 above limits.pressure"));
  EXPECT_EQ(bench.volts, 0);
  bench.readings.analog_V[0] = 10;  // saturated
  bench.Ticks(2, 3);
  EXPECT_THAT(bench.Fault("sensor_p1"), HasSubstr("p1 is not credible"));
  EXPECT_TRUE(std::isnan(bench.measured.p1));
  bench.readings.analog_V[0] = 1;
  bench.Ticks(30, 3);
  EXPECT_TRUE(bench.rig->faults().empty());
  EXPECT_EQ(bench.volts, -1.5);
  bench.readings.interlock_closed = false;
  bench.Ticks(2, 3);
  EXPECT_THAT(bench.Fault("device_fault"), HasSubstr("emergency stop"));
}

// Tests that a device whose output is not what it was set to says so.
TEST(FrontEndRigTest, ReadBack) {
  DeviceBench bench(settings::Replaced(kFrontEndText, "watchdog_s = 0.05", "read_back_tolerance_V = 0.1"));
  bench.before_tick = [&](uint64_t) { bench.readings.read_back_V = bench.device.written_volts; };
  ASSERT_TRUE(bench.Connect());
  bench.Ticks(20, 3);
  EXPECT_TRUE(bench.rig->faults().empty());
  bench.before_tick = [&](uint64_t) { bench.readings.read_back_V = 2; };
  bench.Ticks(3, 3);
  EXPECT_THAT(bench.Fault("output_differs"), HasSubstr("reads back -4 V"));
}

// Tests that a trip which is heard of before it is read is not answered with another arming: it is a fault
// first, and with limits.rearm = "explicit" an operator's to end.
TEST(FrontEndRigTest, ATripIsAFaultFirst) {
  DeviceBench bench;
  ASSERT_TRUE(bench.Connect());
  bench.Ticks(200, 3);
  bench.readings.interlock_closed = false;
  bench.RunDevice();
  bench.readings.interlock_closed = true;
  bench.RunDevice();
  ASSERT_EQ(bench.device.state, HYDRO_TRIPPED);
  EXPECT_TRUE(bench.rig->Arrived());
  bench.rig->Obey(bench.tick);  // the answer to the last reading, which was well
  bench.rig->Drive(3);
  bench.RunDevice();
  EXPECT_EQ(bench.device.state, HYDRO_TRIPPED);
  bench.Tick(3);
  EXPECT_THAT(bench.Fault("device_fault"), HasSubstr("put out zero volts by itself"));
  EXPECT_EQ(bench.device.state, HYDRO_TRIPPED);
}

// Tests that a device which says that it drives, by its own law or by a command that was never sent, while it
// is told zero, is a fault.
TEST(FrontEndRigTest, OutputByNoCommand) {
  for (const uint8_t source : {HYDRO_SOURCE_LAW, HYDRO_SOURCE_VOLTAGE}) {
    DeviceBench bench;
    ASSERT_TRUE(bench.Connect());
    bench.Ticks(150, 0);
    ASSERT_TRUE(bench.rig->faults().empty());
    bench.lie = [source](hydro_sample& sample) {
      sample.state = HYDRO_ARMED;
      sample.source = source;
      sample.command_sequence = 0xfffffff0;
      sample.voltage = 10;
    };
    bench.Ticks(2, 0);
    EXPECT_THAT(
        bench.Fault("output_differs"),
        HasSubstr("puts out 10 V by command 4294967280, which was never sent: the newest has number"));
  }
}

// Tests that no voltage is believed to come from a command that was never sent: by its number, or by the tick
// that the device says it is for; and that a false tick does not make an old command young.
TEST(FrontEndRigTest, CommandsThatWereNeverSent) {
  struct Lie {
    int64_t sequence, host_tick;  // added to what is true
    const char* code;
    const char* text;
  };
  for (const Lie& lie :
       {Lie{100000, 0, "output_differs", "puts out 9 V by command 100154, which was never sent"},
        Lie{0, 10000, "output_differs", "acts by a command for tick"},
        Lie{-4000, 0, "output_differs", ", which was never sent: the newest has number 15"},
        Lie{-140, 0, "device_silent", "acts by a command that was sent more than"}}) {
    DeviceBench bench;
    ASSERT_TRUE(bench.Connect());
    bench.Ticks(150, 3);
    ASSERT_TRUE(bench.rig->faults().empty());
    bench.lie = [&](hydro_sample& sample) {
      sample.command_sequence += static_cast<uint32_t>(lie.sequence);
      sample.host_tick += lie.host_tick;
      if (lie.sequence != 0) sample.voltage = 9;
    };
    for (int i = 0; i < 3 && bench.rig->faults().empty(); ++i) bench.Tick(3);
    EXPECT_THAT(bench.Fault(lie.code), HasSubstr(lie.text)) << lie.sequence;
    EXPECT_EQ(bench.volts, 0);
  }
}

// Tests that a pressure which no credible reading can give is a fault of its sensor although the device
// reports none.
TEST(FrontEndRigTest, ReadingsThatItsSettingsDoNotAllow) {
  std::string driver = kFrontEndText;
  const std::string p2 = "[driver.p2]\n";
  driver.insert(driver.find(p2) + p2.size(), "minimum_V = -0.1\nmaximum_V = 4.6\n");
  for (const float pressure : {-1e30F, -60.0F, 2310.0F}) {
    DeviceBench bench(driver);
    ASSERT_TRUE(bench.Connect());
    bench.Ticks(20, 3);
    ASSERT_TRUE(bench.rig->faults().empty());
    bench.lie = [&](hydro_sample& sample) { sample.value[HYDRO_P2] = pressure; };
    bench.Ticks(2, 3);
    EXPECT_THAT(bench.Fault("sensor_p2"), HasSubstr("driver.p2 allows no such reading"));
    EXPECT_EQ(bench.volts, 0);
  }
}

// Tests that a device which says that it is armed though nobody has asked it to arm is at fault, with zero
// volts too, and is asked to disarm; and that one which was asked and told zero volts is not.
TEST(FrontEndRigTest, ArmedUnasked) {
  DeviceBench bench;
  ASSERT_TRUE(bench.Connect());
  const auto hold = [&](int count) {
    for (int i = 0; i < count; ++i) bench.Tick(0, /*obeys=*/false);
  };
  hold(20);
  ASSERT_TRUE(bench.rig->faults().empty());
  bench.lie = [](hydro_sample& sample) { sample.state = HYDRO_ARMED; };
  hold(3);
  EXPECT_THAT(bench.Fault("device_fault"), HasSubstr("armed with 0 V and was not asked to arm"));
  bench.lie = nullptr;
  hold(3);
  EXPECT_TRUE(bench.rig->faults().empty());

  // It really is, and does as it is told then.
  bench.device.state = HYDRO_ARMED;
  bench.device.obeyed = {};
  hold(2);
  EXPECT_NE(bench.Fault("device_fault"), "");
  hold(60);  // a request each 50 ms
  EXPECT_NE(bench.device.state, HYDRO_ARMED);
  hold(20);

  bench.Ticks(50, 3);
  ASSERT_EQ(bench.volts, -1.5F);
  hold(500);
  EXPECT_TRUE(bench.rig->faults().empty()) << bench.rig->faults().front().text;
  EXPECT_EQ(bench.device.state, HYDRO_ARMED) << "held at zero, ready to go on";
}

// Tests that the driver compares too: a device that says that it puts out something else than it was told,
// and one whose output reads back what nobody has put out, whatever it says of it.
TEST(FrontEndRigTest, OutputDiffers) {
  DeviceBench bench;
  bench.before_tick = [&](uint64_t) { bench.readings.read_back_V = bench.device.written_volts; };
  ASSERT_TRUE(bench.Connect());
  bench.Ticks(20, 3);
  for (int i = 0; i < 200; ++i) bench.Tick(i % 40 < 20 ? 7 : -7);
  EXPECT_TRUE(bench.rig->faults().empty());
  bench.lie = [](hydro_sample& sample) { sample.voltage = 4; };
  bench.Ticks(2, 3);
  EXPECT_THAT(bench.Fault("output_differs"), HasSubstr("says that it puts out 4 V; it was told 3 V"));
  EXPECT_EQ(bench.volts, 0);
  bench.Ticks(5, 3);
  EXPECT_THAT(bench.Fault("output_differs"), HasSubstr("puts out 4 V; it was told 0 V"));
  bench.lie = nullptr;
  bench.Ticks(150, 3);
  EXPECT_TRUE(bench.rig->faults().empty());
  bench.before_tick = [&](uint64_t) { bench.readings.read_back_V = -2.5; };
  bench.Ticks(3, 3);
  EXPECT_THAT(bench.Fault("output_differs"), HasSubstr("reads back 5 V; 3 V was put out"));
  EXPECT_EQ(bench.volts, 0);
  bench.before_tick = [&](uint64_t) { bench.readings.read_back_V = NAN; };
  bench.Ticks(5, 3);
  EXPECT_TRUE(bench.rig->faults().empty()) << "a board that cannot read back";
  bench.before_tick = nullptr;
  bench.lie = [](hydro_sample& sample) { sample.read_back = INFINITY; };
  bench.Ticks(5, 3);
  EXPECT_NE(bench.Fault("output_differs"), "") << "that is no number, and not the word for none";
}

// Tests that a signal that is no number is the fault of its sensor although the device reports none, that a
// rate of it is not another, and that sensors which are not configured have none.
TEST(FrontEndRigTest, NoNumberAndNoFault) {
  DeviceBench bench;
  ASSERT_TRUE(bench.Connect());
  bench.Ticks(20, 3);
  for (const float none : {NAN, INFINITY}) {
    bench.lie = [&](hydro_sample& sample) {
      sample.value[HYDRO_P1] = sample.value[HYDRO_MOTOR_ANGLE] = none;
    };
    bench.Ticks(2, 3);
    EXPECT_THAT(bench.Fault("sensor_p1"),
                HasSubstr("for p1 and reports no fault of it; allowed is a number"));
    EXPECT_NE(bench.Fault("sensor_motor_angle"), "");
    EXPECT_EQ(bench.rig->faults().size(), 2U);
    EXPECT_TRUE(std::isnan(bench.measured.p1));
    EXPECT_EQ(bench.volts, 0);
    bench.lie = nullptr;
    bench.Ticks(20, 3);
    EXPECT_TRUE(bench.rig->faults().empty());
  }
  bench.lie = [&](hydro_sample& sample) { sample.value[HYDRO_MOTOR_SPEED] = NAN; };
  bench.Ticks(2, 3);
  EXPECT_NE(bench.Fault("sensor_motor_speed"), "") << "its angle is there";
}

// Tests that the board's name, which anyone may have put there, moves no cursor.
TEST(FrontEndRigTest, ForeignName) {
  DeviceBench bench;
  bench.facts.name = "a\x1b[2J\nb\xff";
  bench.Reset();
  ASSERT_TRUE(bench.Connect());
  EXPECT_EQ(bench.rig->Describe(), "udp://127.0.0.1:7 (a\\x1b[2J\\x0ab\\xff, firmware 1.0.0, 5000 ticks/s)");
}

// Tests that frames of others, old ones and repeated ones change nothing, and are counted.
TEST(FrontEndRigTest, ForgedFrames) {
  DeviceBench bench;
  ASSERT_TRUE(bench.Connect());
  bench.Ticks(20, 3);
  const auto forged = [&](uint32_t session, uint32_t sequence) {
    hydro_frame frame{};
    frame.kind = HYDRO_SAMPLE;
    frame.session = session;
    frame.sequence = sequence;
    frame.body.sample = bench.device.sample;
    frame.body.sample.value[HYDRO_P1] = 1999;
    uint8_t wire[HYDRO_WIRE_MAX];
    const size_t count = hydro_encode(&frame, wire);
    bench.SendToComputer(Bytes(wire, wire + count));
  };
  const int64_t refused = bench.rig->connection().counts().refused;
  forged(0x9999, bench.device.sent + 1);
  forged(0, bench.device.sent + 1);
  forged(0x1234, bench.device.sent - 1);  // of an earlier time
  forged(0x1234, bench.device.sent + 0x80000000);
  bench.Tick(3);
  EXPECT_EQ(bench.measured.p1, 125);
  EXPECT_EQ(bench.rig->connection().counts().refused - refused, 4);
  EXPECT_TRUE(bench.rig->faults().empty());
}

// Tests that settings which somebody else has put into the device stop it at the next command, by their
// fingerprint.
TEST(FrontEndRigTest, WrongFingerprint) {
  DeviceBench bench;
  ASSERT_TRUE(bench.Connect());
  bench.Ticks(20, 3);
  bench.device.settings.voltage_limit = 100;
  bench.device.fingerprint = hydro_fingerprint(&bench.device.settings);
  std::string fault;
  for (int i = 0; i < 5 && fault.empty(); ++i) {
    bench.Tick(3);
    fault = bench.Fault("device_fault");
    EXPECT_EQ(bench.volts, 0);
  }
  EXPECT_THAT(fault, HasSubstr("a command made for other settings"));
  for (int i = 0; i < 200; ++i) bench.Tick(3, /*obeys=*/false);
  EXPECT_EQ(bench.device.settings.voltage_limit, 8) << "it has got ours again, and waits to be armed";
  EXPECT_EQ(bench.device.state, HYDRO_READY);
}

// Tests that settings which a device says it has kept over a reset are sent and compared all the same: that
// its fingerprint is the right one is only its word.
TEST(FrontEndRigTest, SettingsKeptOverAReset) {
  DeviceBench bench;
  ASSERT_TRUE(bench.Connect());
  bench.Ticks(20, 3);
  const uint32_t kept = bench.device.fingerprint;
  hydro_settings other = bench.device.settings;
  other.voltage_limit = 100;
  bench.Reset();
  bench.before_tick = [&](uint64_t) {
    if (bench.device.settings.voltage_limit == 8) return;
    bench.device.settings = other;
    bench.device.fingerprint = kept;
  };
  for (int i = 0; i < 200; ++i) bench.Tick(3, /*obeys=*/false);
  EXPECT_EQ(bench.device.settings.voltage_limit, 8);
}

// Tests the end of a run: the device says that its output is at zero, and is disarmed.
TEST(FrontEndRigTest, Zero) {
  DeviceBench bench;
  ASSERT_TRUE(bench.Connect());
  bench.Ticks(20, 3);
  bench.rig->ZeroAtOnce();
  bench.RunDevice();
  EXPECT_EQ(bench.device.state, HYDRO_READY);
  EXPECT_EQ(bench.volts, 0);
  const OutputLeft left = bench.rig->Zero();
  EXPECT_TRUE(left.accepted);
  EXPECT_TRUE(std::isnan(left.voltage)) << "this board reads nothing back";
  bench.readings.read_back_V = 0;
  bench.RunDevice();
  EXPECT_EQ(bench.rig->Zero().voltage, 0);
  bench.lie = [](hydro_sample& sample) { sample.voltage = 5; };
  bench.RunDevice();
  EXPECT_FALSE(bench.rig->Zero().accepted) << "its output holds zero, and it says that it puts out 5 V";
  EXPECT_EQ(bench.rig->Zero().voltage, 5);
  bench.lie = nullptr;
  bench.readings.read_back_V = 2;
  bench.RunDevice();
  EXPECT_FALSE(bench.rig->Zero().accepted) << "it says so, but its output does not hold it";
  EXPECT_EQ(bench.rig->Zero().voltage, -4);
  bench.link->Unplug();
  EXPECT_FALSE(bench.rig->Zero().accepted) << "nobody is there to say so";
}

}  // namespace
}  // namespace hydro::plant
