// Who is in command of a device, and what it makes of frames that are old, repeated, foreign or forged.
#include <gtest/gtest.h>

#include "tests/firmware/device_bench.h"

namespace hydro::firmware {
namespace {

using testing::BenchSettings;
using testing::Bytes;
using testing::DeviceBench;
using testing::Wire;

// Tests that a hello is answered with what the device is, and that its settings come back whole.
TEST(DeviceSessionTest, Handshake) {
  DeviceBench bench;
  EXPECT_TRUE(bench.Hello());
  bench.Collect();
  const auto identity = bench.Sent(HYDRO_IDENTITY);
  ASSERT_TRUE(identity);
  EXPECT_EQ(identity->session, bench.session);
  EXPECT_EQ(identity->body.identity.session_in_charge, bench.session);
  EXPECT_EQ(identity->body.identity.boot, 42U);
  EXPECT_EQ(identity->body.identity.tick_rate_hz, 1000U);
  EXPECT_EQ(identity->body.identity.fingerprint, 0U);
  EXPECT_STREQ(identity->body.identity.board, "bench");
  bench.Settings();
  bench.Collect();
  const auto held = bench.Sent(HYDRO_SETTINGS_HELD);
  ASSERT_TRUE(held);
  EXPECT_EQ(held->body.held.refused, HYDRO_TAKEN);
  EXPECT_EQ(held->body.held.fingerprint, hydro_fingerprint(&bench.settings));
  EXPECT_EQ(hydro_fingerprint(&held->body.held.settings), hydro_fingerprint(&bench.settings));
}

// Tests that settings which are refused leave those in force, and that none are taken while the device is
// armed.
TEST(DeviceSessionTest, SettingsRefused) {
  DeviceBench bench;
  bench.Ready();
  const uint32_t fingerprint = hydro_fingerprint(&bench.settings);
  hydro_frame frame = bench.Frame(HYDRO_SETTINGS);
  frame.body.settings = bench.settings;
  frame.body.settings.sensors[HYDRO_P2].channel = 9;
  bench.Send(frame);
  bench.Collect();
  EXPECT_EQ(bench.Sent(HYDRO_SETTINGS_HELD)->body.held.refused, HYDRO_REFUSED_SENSOR);
  EXPECT_EQ(bench.Sent(HYDRO_SETTINGS_HELD)->body.held.refused_part, HYDRO_P2);
  EXPECT_EQ(bench.Sent(HYDRO_SETTINGS_HELD)->body.held.fingerprint, fingerprint);
  bench.Arm();
  bench.Send(bench.Voltage(3));
  bench.Settings();
  EXPECT_FLOAT_EQ(bench.Tick(), -1.25F);
  EXPECT_EQ(bench.Sent(HYDRO_SETTINGS_HELD)->body.held.refused, HYDRO_REFUSED_ARMED);
}

// Tests that commands made for other settings are not obeyed and trip an armed device, and that an arm
// request is not taken with another fingerprint.
TEST(DeviceSessionTest, WrongFingerprint) {
  DeviceBench bench;
  bench.Ready();
  hydro_frame arm = bench.Frame(HYDRO_ARM);
  arm.body.arm = {hydro_fingerprint(&bench.settings) ^ 1, 0};
  bench.Send(arm);
  bench.Tick();
  EXPECT_EQ(bench.sample.state, HYDRO_READY);
  EXPECT_EQ(bench.sample.faults_present, HYDRO_FAULT_FINGERPRINT);
  EXPECT_EQ(bench.sample.frames_refused, 1);
  bench.Tick();
  EXPECT_EQ(bench.sample.faults_present, 0);
  bench.Arm();
  bench.Send(bench.Voltage(3));
  EXPECT_FLOAT_EQ(bench.Tick(), -1.25F);
  hydro_frame command = bench.Voltage(4);
  command.body.command.fingerprint ^= 0x80000000;
  bench.Send(command);
  EXPECT_FLOAT_EQ(bench.Tick(), bench.Zero());
  EXPECT_EQ(bench.sample.faults_latched, HYDRO_FAULT_FINGERPRINT);
}

// Tests that a forged frame, whole but of another session, neither acts nor counts as a sign of life.
TEST(DeviceSessionTest, ForgedFrames) {
  DeviceBench bench;
  bench.Armed();
  bench.Send(bench.Voltage(3));
  for (int tick = 0; tick < 20; ++tick) {
    hydro_frame forged = bench.Voltage(8);
    forged.session ^= 1;
    bench.Send(forged);
    ASSERT_FLOAT_EQ(bench.Tick(), -1.25F);
  }
  hydro_frame forged = bench.Voltage(8);
  forged.session = 0;
  bench.Send(forged);
  EXPECT_FLOAT_EQ(bench.Tick(), bench.Zero());
  EXPECT_EQ(bench.sample.faults_latched, HYDRO_FAULT_WATCHDOG);
  EXPECT_EQ(bench.sample.frames_refused, 21);
}

// Tests that the frames of a device itself, on a line whose ends are joined, do nothing to it.
TEST(DeviceSessionTest, ItsOwnFramesComeBack) {
  DeviceBench bench;
  bench.Armed();
  bench.Send(bench.Voltage(3));
  for (int tick = 0; tick < 10; ++tick) {
    EXPECT_FLOAT_EQ(bench.Tick(), -1.25F);
    for (const hydro_frame& frame : bench.sent) bench.Send(frame);
  }
  EXPECT_EQ(bench.device.state, HYDRO_ARMED);
  EXPECT_EQ(bench.device.newest, bench.sequence);
}

// Tests that commands which come twice, or after newer ones, are neither obeyed nor a sign of life.
TEST(DeviceSessionTest, OldAndRepeatedCommands) {
  DeviceBench bench;
  bench.Armed();
  const hydro_frame old = bench.Voltage(7), newest = bench.Voltage(3);
  bench.Send(newest);
  bench.Tick();
  for (int tick = 1; tick < 20; ++tick) {
    bench.Send(tick % 2 == 0 ? old : newest);
    ASSERT_FLOAT_EQ(bench.Tick(), -1.25F);
  }
  bench.Send(newest);
  EXPECT_FLOAT_EQ(bench.Tick(), bench.Zero());
}

// Tests that sequences go on over 2^32.
TEST(DeviceSessionTest, SequenceWraps) {
  DeviceBench bench;
  bench.sequence = 0xFFFFFFF0;
  bench.Armed();
  for (int tick = 0; tick < 100; ++tick) {
    bench.Send(bench.Voltage(static_cast<float>(tick % 7)));
    bench.Tick();
    ASSERT_EQ(bench.sample.voltage, static_cast<float>(tick % 7));
  }
}

// Tests that an arm request from before a trip, delivered late, does not arm.
TEST(DeviceSessionTest, ArmFromBeforeATrip) {
  DeviceBench bench;
  bench.Armed();
  hydro_frame late = bench.Frame(HYDRO_ARM);
  late.body.arm = {hydro_fingerprint(&bench.settings), bench.device.trips};
  for (int tick = 0; tick < 30; ++tick) bench.Tick();
  ASSERT_EQ(bench.sample.state, HYDRO_TRIPPED);
  bench.Send(late);
  EXPECT_EQ(bench.device.state, HYDRO_TRIPPED);
  bench.Arm();
  EXPECT_EQ(bench.device.state, HYDRO_ARMED);
}

// Tests that zero volts are obeyed from anybody, with any sequence, and that only a re-arm ends them.
TEST(DeviceSessionTest, ZeroIsObeyedFromAnybody) {
  for (const uint32_t session : {0xA1B2C3D4U, 0U, 99U}) {
    DeviceBench bench;
    bench.Armed();
    bench.Send(bench.Voltage(3));
    bench.Tick();
    hydro_frame zero = bench.Frame(HYDRO_ZERO);
    zero.session = session;
    zero.sequence = 0;
    bench.Send(zero);
    bench.Send(bench.Voltage(3));
    EXPECT_FLOAT_EQ(bench.Tick(), bench.Zero());
    EXPECT_EQ(bench.sample.state, HYDRO_READY);
    EXPECT_EQ(bench.sample.trips, 1U);
    EXPECT_EQ(bench.sample.faults_latched, 0);
    bench.Arm();
    bench.Send(bench.Voltage(3));
    EXPECT_FLOAT_EQ(bench.Tick(), -1.25F);
  }
}

// Tests that a second computer gets an answer but not the device, while the first one drives or is heard; and
// gets it, without settings, a quarter of a second after the first one fell silent.
TEST(DeviceSessionTest, SecondComputer) {
  DeviceBench bench;
  bench.Armed();
  bench.Send(bench.Voltage(3));
  bench.Tick();
  hydro_frame hello{};
  hello.kind = HYDRO_HELLO;
  hello.session = 77;
  EXPECT_FALSE(bench.Send(hello));
  EXPECT_FLOAT_EQ(bench.Tick(), -1.25F);
  EXPECT_EQ(bench.Sent(HYDRO_IDENTITY)->body.identity.session_in_charge, bench.session);
  EXPECT_EQ(bench.Sent(HYDRO_IDENTITY)->body.identity.state, HYDRO_ARMED);
  for (int tick = 1; tick < 249; ++tick) {
    EXPECT_FALSE(bench.Send(hello)) << tick;
    bench.Tick();
  }
  EXPECT_EQ(bench.device.state, HYDRO_TRIPPED);
  bench.Tick();
  EXPECT_TRUE(bench.Send(hello));
  bench.Collect();
  EXPECT_EQ(bench.Sent(HYDRO_IDENTITY)->body.identity.session_in_charge, 77U);
  EXPECT_EQ(bench.device.state, HYDRO_IDLE);
  EXPECT_EQ(bench.device.fingerprint, 0U);
  EXPECT_FLOAT_EQ(bench.Tick(), bench.Zero());  // still that of the amplifier
  bench.Send(bench.Voltage(3));                 // the first one comes back to life
  bench.Arm();
  EXPECT_FLOAT_EQ(bench.Tick(), bench.Zero());
}

// Tests that a hello without a session, or of another protocol, is answered and takes nothing.
TEST(DeviceSessionTest, HelloThatTakesNothing) {
  DeviceBench bench;
  bench.session = 0;
  EXPECT_FALSE(bench.Hello());
  bench.Collect();
  EXPECT_EQ(bench.Sent(HYDRO_IDENTITY)->body.identity.session_in_charge, 0U);
  const Bytes wire =
      testing::Stuffed({9, HYDRO_HELLO, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});  // protocol 9, session 1
  bench.sent.clear();
  EXPECT_FALSE(bench.Send(wire));
  bench.Collect();
  EXPECT_TRUE(bench.Sent(HYDRO_IDENTITY)) << "no answer";
  EXPECT_EQ(bench.device.session, 0U);
}

// Tests that a device that was reset does nothing of what its computer goes on sending.
TEST(DeviceSessionTest, Reset) {
  DeviceBench bench;
  bench.Armed();
  bench.Send(bench.Voltage(3));
  bench.Tick();
  const hydro_board_facts facts = testing::BenchFacts();
  hydro_device_begin(&bench.device, &facts);
  bench.sent.clear();
  for (int tick = 0; tick < 100; ++tick) {
    bench.Send(bench.Voltage(3));
    bench.Arm();
    bench.Settings();
    ASSERT_EQ(bench.Tick(), 0);
  }
  EXPECT_TRUE(bench.sent.empty());
}

// Tests that samples come every so many ticks, numbered without a gap.
TEST(DeviceSessionTest, SamplesEverySoManyTicks) {
  hydro_settings settings = BenchSettings();
  settings.sample_interval_ticks = 5;
  DeviceBench bench(settings);
  bench.Ready();
  bench.sent.clear();
  for (int tick = 0; tick < 100; ++tick) bench.Tick();
  ASSERT_EQ(bench.sent.size(), 20U);
  for (size_t i = 1; i < bench.sent.size(); ++i) {
    EXPECT_EQ(bench.sent[i].sequence, bench.sent[i - 1].sequence + 1);
    EXPECT_EQ(bench.sent[i].body.sample.tick, bench.sent[i - 1].body.sample.tick + 5);
  }
}

// Tests that bit errors, losses, repetitions and exchanges of commands at rates from 1e-5 to 1e-2 change
// nothing but counts: the device stays armed, and obeys commands that were sent, in their order.
TEST(DeviceSessionTest, DamagedLink) {
  for (const double rate : {1e-5, 1e-4, 1e-3, 1e-2}) {
    std::mt19937 random(13);
    std::bernoulli_distribution strikes(rate), wrong_bit(rate / 10);
    DeviceBench bench;
    bench.Armed();
    uint32_t newest = 0;
    int obeyed = 0, damaged = 0;
    Bytes held_back;
    for (int tick = 0; tick < 20000; ++tick) {
      Bytes wire = Wire(bench.Voltage(static_cast<float>(tick % 1000) / 200));
      for (size_t bit = 0; bit < 8 * wire.size(); ++bit) {
        if (!wrong_bit(random)) continue;
        wire[bit / 8] ^= static_cast<uint8_t>(1U << (bit % 8));
        ++damaged;
      }
      const bool lost = strikes(random), twice = strikes(random), late = strikes(random);
      damaged += lost || twice || late;
      if (late) {
        std::swap(held_back, wire);
      } else if (!lost) {
        bench.Send(wire);
        if (twice) bench.Send(wire);
        bench.Send(held_back);
        held_back.clear();
      }
      bench.Tick();
      ASSERT_EQ(bench.sample.state, HYDRO_ARMED) << "rate " << rate << ", tick " << tick;
      const uint32_t sequence = bench.sample.command_sequence;
      if (sequence == 0) continue;
      ASSERT_FALSE(hydro_is_newer(newest, sequence));
      obeyed += sequence != newest;
      newest = sequence;
      const float sent = static_cast<float>((sequence - 4) % 1000) / 200;
      ASSERT_EQ(bench.sample.voltage, sent);
    }
    EXPECT_GT(obeyed, 20000 * 0.6);
    EXPECT_GT(damaged, 0) << rate;
  }
}

}  // namespace
}  // namespace hydro::firmware
