// What damage on the way, and devices that are not the right ones, do to a rig behind a front end.
#include <gmock/gmock.h>

#include "base/input_error.h"
#include "tests/firmware/frame_maker.h"
#include "tests/plant/front_end/device_bench.h"

namespace hydro::plant {
namespace {

using settings::InputErrorOf;
using ::testing::AllOf;
using ::testing::HasSubstr;

float VoltageOf(int64_t host_tick) { return static_cast<float>(host_tick % 13) - 6; }
float PressureOf(uint64_t tick) { return static_cast<float>(tick % 1000); }

struct Outcome {
  FrameCounts counts;
  int faults = 0;
  int wrong = 0;   // samples or voltages that nobody has sent
  int oldest = 0;  // ms, of the newest sample
  uint32_t trips = 0;
  bool connected = false;
};

// Two seconds of driving over such a wire.
Outcome Driven(const Damage& damage) {
  DeviceBench bench(kFrontEndText, damage);
  bench.before_tick = [&](uint64_t tick) { bench.readings.analog_V[0] = PressureOf(tick) / 500; };
  Outcome outcome;
  outcome.connected = bench.Connect(2000);
  if (!outcome.connected) return outcome;
  for (int i = 0; i < 2000; ++i) {
    bench.Tick(VoltageOf(bench.tick + 1));
    outcome.faults += !bench.rig->faults().empty();
    const hydro_sample& sample = bench.rig->connection().sample();
    const bool as_commanded = sample.source == HYDRO_SOURCE_ZERO ||
                              sample.voltage == VoltageOf(sample.host_tick) || sample.voltage == 0;
    outcome.wrong += !as_commanded || std::fabs(sample.value[HYDRO_P1] - PressureOf(sample.tick)) > 1e-3;
    const auto age = static_cast<int>((bench.device.tick - sample.tick) / DeviceBench::kTicks);
    if (i > 20) outcome.oldest = std::max(outcome.oldest, age);
  }
  outcome.counts = bench.rig->connection().counts();
  outcome.trips = bench.device.trips;
  return outcome;
}

// Tests that frames which are flipped in a bit, lost, doubled or late, up to one in a hundred of each, change
// nothing but counts.
TEST(FrontEndTroubleTest, DamageChangesNothingButCounts) {
  int64_t seen = 0;
  for (const double rate : {0.0, 1e-5, 1e-4, 1e-3, 1e-2}) {
    const Outcome outcome =
        Driven({.flipped_frame = rate, .lost_frame = rate, .doubled_frame = rate, .late_frame = rate});
    ASSERT_TRUE(outcome.connected) << rate;
    EXPECT_EQ(outcome.faults, 0) << rate;
    EXPECT_EQ(outcome.wrong, 0) << rate;
    EXPECT_EQ(outcome.trips, 0U) << rate;
    const FrameCounts& counts = outcome.counts;
    const int64_t all =
        counts.lost + counts.damaged + counts.refused + counts.device_damaged + counts.device_refused;
    EXPECT_GE(all, seen) << rate;
    seen = all;
    if (rate == 0) {
      EXPECT_EQ(all, 0);
      EXPECT_EQ(outcome.oldest, 1) << "the newest sample is that of the tick before";
    }
    if (rate < 1e-2) continue;
    EXPECT_GT(counts.lost, 0);
    EXPECT_GT(counts.damaged, 0);
    EXPECT_GT(counts.refused, 0);
    EXPECT_GT(counts.device_damaged, 0);
    EXPECT_GT(counts.device_refused, 0);
  }
}

// Tests that a front end which answers from another address than the one that is asked is found, at the start
// and in the run, in words that name it; and that what came from there before the device fell silent is none.
TEST(FrontEndTroubleTest, AnswersFromElsewhere) {
  DeviceBench bench;
  bench.device_runs = false;
  bench.link->elsewhere = "127.0.0.1:7701";
  EXPECT_FALSE(bench.Connect(200));
  EXPECT_EQ(bench.rig->connection().WhyNot().found,
            "answers from 127.0.0.1:7701, which are not used, and no others");
  EXPECT_THAT(bench.rig->connection().WhyNot().allowed,
              HasSubstr("answers from the address that it is asked at: give its own in driver.url, or let"));
  bench.device_runs = true;
  ASSERT_TRUE(bench.Connect());
  bench.Ticks(150, 3);
  EXPECT_EQ(bench.rig->connection().elsewhere(), "");
  bench.link->elsewhere.clear();
  bench.device_runs = false;
  bench.Ticks(150, 3);
  EXPECT_THAT(bench.Fault("device_silent"), ::testing::EndsWith("(limits.stale_input_s)"));
  bench.link->elsewhere = "[::1]:7702";
  bench.Ticks(150, 3);
  EXPECT_THAT(bench.Fault("device_silent"),
              ::testing::EndsWith("; found answers from [::1]:7702, which are not used"));
}

// Tests the same with errors in each bit: at 1e-2 no frame arrives, and that is silence, not a wrong one.
TEST(FrontEndTroubleTest, BitErrors) {
  for (const double rate : {1e-5, 1e-4, 1e-3}) {
    const Outcome outcome = Driven({.bit = rate});
    ASSERT_TRUE(outcome.connected) << rate;
    EXPECT_EQ(outcome.faults, 0) << rate;
    EXPECT_EQ(outcome.wrong, 0) << rate;
    EXPECT_EQ(outcome.trips, 0U) << rate;
    EXPECT_GT(outcome.counts.damaged, 0) << rate;
  }
  EXPECT_FALSE(Driven({.bit = 1e-2}).connected);
}

// Tests that a wire which suddenly carries nothing whole is a fault, that nothing is obeyed then, and that
// all is well once it is.
TEST(FrontEndTroubleTest, WireThatBreaksAndHeals) {
  DeviceBench bench;
  ASSERT_TRUE(bench.Connect());
  bench.Ticks(20, 3);
  bench.to_device = Wire({.bit = 0.02}, 3);
  bench.to_computer = Wire({.bit = 0.02}, 4);
  bench.Ticks(150, 3);
  EXPECT_NE(bench.Fault("device_silent"), "");
  EXPECT_EQ(bench.device.state, HYDRO_TRIPPED);
  EXPECT_EQ(bench.volts, 0);
  bench.to_device = bench.to_computer = Wire({}, 5);
  bench.Ticks(200, 3);
  EXPECT_TRUE(bench.rig->faults().empty());
  EXPECT_EQ(bench.volts, -1.5);
}

// Tests that commands which no longer reach the device are noticed by the age of what it obeys, where its
// samples still come.
TEST(FrontEndTroubleTest, OneWay) {
  DeviceBench bench(settings::Replaced(kFrontEndText, "watchdog_s = 0.05", "watchdog_s = 1"));
  ASSERT_TRUE(bench.Connect());
  bench.Ticks(20, 3);
  bench.to_device = Wire({.lost_frame = 1}, 3);
  int ticks = 0;
  for (; ticks < 500 && bench.rig->faults().empty(); ++ticks) bench.Tick(3);
  EXPECT_NEAR(ticks, 103, 3);
  EXPECT_THAT(bench.Fault("device_silent"), HasSubstr("obeys commands of"));
}

// Tests the same where this process wakes up late all the time, and so skips ticks.
TEST(FrontEndTroubleTest, OneWayAndLate) {
  DeviceBench bench(settings::Replaced(kFrontEndText, "watchdog_s = 0.05", "watchdog_s = 1"));
  ASSERT_TRUE(bench.Connect());
  bench.Ticks(20, 3);
  bench.to_device = Wire({.lost_frame = 1}, 3);
  const int64_t begin = bench.tick;
  while (bench.tick < begin + 500 && bench.rig->faults().empty()) {
    bench.tick += 4;
    bench.Tick(3);
  }
  EXPECT_NEAR(static_cast<double>(bench.tick - begin), 103, 6);
}

std::string WhyNot(const std::function<void(DeviceBench&)>& change) {
  DeviceBench bench;
  change(bench);
  EXPECT_FALSE(bench.Connect(300));
  const LinkTrouble trouble = bench.rig->connection().WhyNot();
  return trouble.found + ", allowed " + trouble.allowed;
}

Bytes Encoded(hydro_frame frame) {
  uint8_t wire[HYDRO_WIRE_MAX];
  const size_t count = hydro_encode(&frame, wire);
  return Bytes(wire, wire + count);
}

// How many ZEROs the rig sends when it is asked for zero volts at once.
int ZerosAtOnce(DeviceBench* bench) {
  Bytes packet(512);
  const auto receive = [&] {
    return recv(bench->link->other_end, packet.data(), packet.size(), MSG_DONTWAIT);
  };
  while (receive() > 0) {
  }
  bench->rig->ZeroAtOnce();
  int zeros = 0;
  while (receive() > 0) ++zeros;
  return zeros;
}

// Tests that a program which is refused because another one commands the device does not take that one's
// volts away, and that whoever has commanded it once asks for zero, though another session has taken over.
TEST(FrontEndTroubleTest, LeavesWhatAnotherCommands) {
  uint32_t sequence = 100;
  const auto say = [&](DeviceBench& bench, uint32_t session) {
    hydro_frame frame{};
    frame.kind = HYDRO_IDENTITY;
    frame.sequence = ++sequence;
    frame.body.identity.session_in_charge = session;
    bench.SendToComputer(Encoded(frame));
    bench.rig->Poll();
  };
  DeviceBench refused;
  refused.device_runs = false;
  refused.rig->Poll();
  EXPECT_EQ(ZerosAtOnce(&refused), 1);  // nobody is known to be in charge
  say(refused, 0x99);
  EXPECT_EQ(ZerosAtOnce(&refused), 0);
  say(refused, 0);
  EXPECT_EQ(ZerosAtOnce(&refused), 1);

  DeviceBench taken;
  ASSERT_TRUE(taken.Connect());
  EXPECT_EQ(ZerosAtOnce(&taken), 1);
  say(taken, 0x99);
  EXPECT_EQ(ZerosAtOnce(&taken), 1);
}

// Says in the device's place who it is, as the newest of its frames.
void Identify(DeviceBench* bench, uint32_t session_in_charge, uint32_t boot) {
  hydro_frame frame{};
  frame.kind = HYDRO_IDENTITY;
  frame.session = 0x1234;
  frame.sequence = bench->device.sent++;
  frame.body.identity = bench->rig->connection().identity();
  frame.body.identity.session_in_charge = session_in_charge;
  frame.body.identity.boot = boot;
  bench->SendToComputer(Encoded(frame));
}

// Tests that a device which drives and says that no session commands it, or another one, or that it has
// restarted, is at zero volts in the tick that finds it, and as long as it says so.
TEST(FrontEndTroubleTest, ZeroWhileItIsNotUp) {
  struct Case {
    uint32_t session, boot;
    const char* code;
    const char* says;
  };
  for (const Case& each : {Case{0, 7, "device_silent", "no session commands"},
                           Case{0x99, 7, "device_silent", "another program commands"},
                           Case{0x1234, 8, "device_fault", "has reset itself"}}) {
    DeviceBench bench;
    ASSERT_TRUE(bench.Connect());
    bench.Ticks(150, 3);
    ASSERT_EQ(bench.volts, -1.5F);
    for (uint32_t i = 0; i < 10; ++i) {
      Identify(&bench, each.session, each.boot + (each.boot != 7 ? i : 0));
      bench.Tick(3);
      EXPECT_THAT(bench.Fault(each.code), HasSubstr(each.says));
      EXPECT_EQ(bench.volts, 0) << each.says << ", " << i;
    }
  }
}

// How many ZEROs the rig sends in so many ticks to a device that says nothing.
int ZerosWithin(DeviceBench* bench, int ticks) {
  bench->device_runs = false;
  int zeros = 0;
  for (int i = 0; i < ticks; ++i) {
    bench->Tick(3);
    hydro_receiver receiver{};
    hydro_frame frame{};
    Bytes packet(512);
    ssize_t got = 0;
    while ((got = recv(bench->link->other_end, packet.data(), packet.size(), MSG_DONTWAIT)) > 0) {
      for (ssize_t byte = 0; byte < got; ++byte) {
        if (hydro_receive(&receiver, packet[static_cast<size_t>(byte)], &frame))
          zeros += frame.kind == HYDRO_ZERO;
      }
    }
  }
  return zeros;
}

// Tests that a device which another session commands is sent ZEROs while it may still act by this one's last
// command, and is left to the other program afterwards.
TEST(FrontEndTroubleTest, LeavesWhatAnotherHasTakenOver) {
  DeviceBench bench;
  ASSERT_TRUE(bench.Connect());
  bench.Ticks(150, 3);
  Identify(&bench, 0x99, 7);
  EXPECT_EQ(ZerosWithin(&bench, 240), 5) << "each 50 ms";
  EXPECT_EQ(ZerosWithin(&bench, 20), 0);
  EXPECT_THAT(bench.Fault("device_silent"), HasSubstr("it is left to that program"));
  EXPECT_EQ(ZerosWithin(&bench, 500), 0);
}

// Tests what is said when no front end answers, or one that is not ours to command.
TEST(FrontEndTroubleTest, NobodyOrSomebodyElse) {
  EXPECT_THAT(WhyNot([](DeviceBench& bench) { bench.device_runs = false; }),
              HasSubstr("nothing that answers, allowed a front end"));
  EXPECT_THAT(WhyNot([](DeviceBench& bench) {
                bench.device_runs = false;
                bench.rig->Poll();
                bench.SendToComputer({'H', 'e', 'l', 'l', 'o', '\r', '\n', 0, 'x', 0});
              }),
              AllOf(HasSubstr("10 bytes that are no frames"), HasSubstr("another baud rate")));
  EXPECT_THAT(WhyNot([](DeviceBench& bench) {
                bench.device_runs = false;
                bench.rig->Poll();
                hydro_frame hello{};
                hello.kind = HYDRO_HELLO;
                bench.SendToComputer(Encoded(hello));
              }),
              HasSubstr("only what this computer itself had sent"));
  EXPECT_THAT(WhyNot([](DeviceBench& bench) {
                bench.device_runs = false;
                bench.rig->Poll();
                Bytes content(72);
                content[0] = 2;  // the protocol
                content[1] = HYDRO_IDENTITY;
                bench.SendToComputer(firmware::testing::Stuffed(content));
              }),
              HasSubstr("a front end that speaks protocol 2, allowed protocol 1"));
  EXPECT_THAT(WhyNot([](DeviceBench& bench) {
                bench.device.session = 0xabcd;
                bench.before_tick = [&](uint64_t) { bench.device.heard_ticks = 0; };
              }),
              HasSubstr("another program commands (its session is 0000abcd)"));
  EXPECT_THAT(WhyNot([](DeviceBench& bench) { bench.link->plugged = false; }),
              HasSubstr("\"cable\" (No such file or directory)"));
}

// Tests that a session which nobody uses any more is taken over.
TEST(FrontEndTroubleTest, TakesOver) {
  DeviceBench bench;
  bench.device.session = 0xabcd;
  EXPECT_TRUE(bench.Connect());
  EXPECT_EQ(bench.device.session, 0x1234U);
}

// What is said of a device that is wrong for the configuration.
std::string Wrong(
    const std::string& driver,
    const std::function<void(hydro_board_facts&)>& change = [](hydro_board_facts&) {}) {
  DeviceBench bench(driver);
  change(bench.facts);
  bench.Reset();
  return InputErrorOf([&] { bench.Connect(); });
}

// Tests that a device which cannot do what the configuration names is refused, with the key.
TEST(FrontEndTroubleTest, WrongDevice) {
  const std::string text = kFrontEndText;
  const auto changed = [&](const std::string& from, const std::string& to) {
    return settings::Replaced(text, from, to);
  };
  EXPECT_EQ(Wrong(text), "");
  EXPECT_EQ(Wrong(text, [](auto& facts) { facts.tick_rate_hz = 4500; }),
            "stack.toml: plant.rate_hz: found 1000, allowed a rate that divides the front end's 4500 ticks "
            "per second");
  EXPECT_EQ(
      Wrong(text, [](auto& facts) { facts.analog_inputs = 2; }),
      "stack.toml: driver.arm_angle.channel: found 2, allowed 0 to 1: the front end has 2 analog inputs");
  EXPECT_EQ(Wrong(text, [](auto& facts) { facts.counters = 0; }),
            "stack.toml: driver.motor_angle.channel: found 0, allowed a front end with counters: this one "
            "has none");
  EXPECT_EQ(Wrong(changed("scale = -2.0", "scale = -2.0\noffset = 30"),
                  [](auto& facts) { facts.output_max_V = 5; }),
            "stack.toml: driver.voltage.offset: found 30, allowed one with which zero volts are within the "
            "front end's output, -10 "
            "to 5 V at the terminal");
  EXPECT_EQ(
      Wrong(text, [](auto& facts) { facts.output_max_V = NAN; }),
      "stack.toml: driver.url: found a front end whose output goes from -10 to nan V, as it says, allowed "
      "one with a range of two numbers, the smaller one first: give its board's firmware the converter's "
      "range");
  EXPECT_EQ(Wrong(changed("0.05", "0.0001")),
            "stack.toml: driver.watchdog_s: found 0.0001, allowed 0.0002 to 1: from one tick of the front "
            "end to a second");
  EXPECT_EQ(
      Wrong(text, [](auto& facts) { facts.tick_rate_hz = 0; }),
      "stack.toml: driver.url: found a front end of 0 ticks per second, as it says, allowed one that says "
      "how many it takes: give its board's firmware the rate of its timer");
}

// Tests that numbers which single precision cannot hold are refused by their key before the device gets them
// as 0 or infinity.
TEST(FrontEndTroubleTest, NumbersBeyondSinglePrecision) {
  const std::string size = ", allowed a magnitude of 1.2e-38 to 3.4e+38, which single precision holds: ";
  const auto found = [](const std::string& section, const std::string& line) {
    std::string text = kFrontEndText;
    const size_t at = text.find("[driver" + section + "]\n") + section.size() + 9;
    const std::string key = line.substr(0, line.find(' '));
    if (const size_t old = text.find("\n" + key, at - 1); old < text.find("\n[", at))
      text.erase(old, text.find('\n', old + 1) - old);
    return Wrong(text.insert(at, line + "\n"));
  };
  for (const char* value : {"1e-60", "-1e-60", "1e+39", "-1e+300"}) {
    const auto says = [&](const std::string& key) {
      return "stack.toml: driver." + key + ": found " + value + size;
    };
    const auto line = [&](const std::string& key) { return key + " = " + value; };
    EXPECT_THAT(found(".p1", line("scale")), HasSubstr(says("p1.scale")));
    EXPECT_THAT(found(".arm_angle", line("offset")), HasSubstr(says("arm_angle.offset")));
    EXPECT_THAT(found(".motor_angle", line("scale")), HasSubstr(says("motor_angle.scale")));
    EXPECT_THAT(found(".p2", line("minimum_V")), HasSubstr(says("p2.minimum_V")));
    if (value[0] == '-') continue;
    EXPECT_THAT(found("", line("read_back_tolerance_V")), HasSubstr(says("read_back_tolerance_V")));
    EXPECT_THAT(found(".voltage", line("scale")), HasSubstr(says("voltage.scale")));
    EXPECT_THAT(found(".voltage", line("limit_V")), HasSubstr(says("voltage.limit_V")));
  }
  EXPECT_THAT(found(".p1", "low_pass_hz = 1e-300"),
              HasSubstr("driver.p1.low_pass_hz: found 1e-300, allowed 0 for none, or at least 5.9e-35"));
  EXPECT_EQ(found(".p1", "low_pass_hz = 1"), "");
  EXPECT_EQ(found(".p2", "minimum_V = 0"), "");
}

// Tests that a serial line that is too slow for the samples is refused before anything is sent.
TEST(FrontEndTroubleTest, SlowLine) {
  const std::string slow =
      settings::Replaced(kFrontEndText, "udp://127.0.0.1:7", "serial:/dev/ttyS0?baud=115200");
  EXPECT_EQ(InputErrorOf([&] { const DeviceBench bench(slow); }),
            "stack.toml: driver.url: found baud=115200, allowed at least 1070000 for 1000 samples a second "
            "of 107 bytes (plant.rate_hz)");
  EXPECT_EQ(InputErrorOf([&] { const DeviceBench bench(settings::Replaced(slow, "115200", "1152000")); }),
            "");
}

}  // namespace
}  // namespace hydro::plant
