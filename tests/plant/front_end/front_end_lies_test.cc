// What a rig does with samples that cannot be true: values that nothing gives, fields that contradict each
// other, a clock that does not go on.
#include <gmock/gmock.h>
#include <spdlog/fmt/fmt.h>

#include <cstring>
#include <utility>

#include "tests/plant/front_end/device_bench.h"

namespace hydro::plant {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using Falsify = std::function<void(hydro_sample& sample)>;

// A device that drives with 3 V, and then lies for so many milliseconds.
void Lied(DeviceBench* bench, const Falsify& lie, int ticks = 2) {
  ASSERT_TRUE(bench->Connect());
  bench->Ticks(150, 3);
  ASSERT_TRUE(bench->rig->faults().empty());
  ASSERT_EQ(bench->volts, -1.5F);
  bench->lie = lie;
  bench->Ticks(ticks, 3);
}

// Tests that without minimum_V and maximum_V a reading that no such machine gives is a fault of its sensor,
// and is passed on to nobody; and that the ends are far from what a machine does.
TEST(FrontEndLiesTest, ReadingsThatNoMachineGives) {
  struct Case {
    int sensor;
    float value;
    const char* allowed;  // null: it is credible
  };
  const Case cases[] = {
      {HYDRO_P1, 1e30F, "at most 4000 psi, twice limits.pressure"},
      {HYDRO_P2, -1e30F, "at least -214.696 psi, a vacuum less a tenth of limits.pressure"},
      {HYDRO_P2, 4001, "at most 4000 psi"},
      {HYDRO_P2, -215, "at least -214.696 psi"},
      {HYDRO_P1, -200, nullptr},
      {HYDRO_MOTOR_SPEED, 1e30F, "ten times T_pmax/b"},
      {HYDRO_MOTOR_SPEED, -28000, "ten times T_pmax/b"},
      {HYDRO_MOTOR_SPEED, -3000, nullptr},
      {HYDRO_ARM_ANGLE, 1e30F, "twice limits.arm_angle"},
      {HYDRO_ARM_ANGLE, -2, "twice limits.arm_angle"},
      {HYDRO_ARM_ANGLE, 0.9F, nullptr},
  };
  for (const Case& each : cases) {
    DeviceBench bench;
    Lied(&bench, [&](hydro_sample& sample) { sample.value[each.sensor] = each.value; });
    const double read[] = {bench.measured.p1,          bench.measured.p2,        bench.measured.motor_angle,
                           bench.measured.motor_speed, bench.measured.arm_angle, bench.measured.arm_speed};
    const double signal = read[each.sensor];
    if (each.allowed == nullptr) {
      EXPECT_TRUE(bench.rig->faults().empty()) << bench.rig->faults().front().text;
      EXPECT_EQ(signal, static_cast<double>(each.value));
      continue;
    }
    const std::string code = std::vector<const char*>{
        "sensor_p1",          "sensor_p2",        "sensor_motor_angle",
        "sensor_motor_speed", "sensor_arm_angle", "sensor_arm_speed"}[static_cast<size_t>(each.sensor)];
    EXPECT_THAT(bench.Fault(code), AllOf(HasSubstr("allows no such reading"), HasSubstr(each.allowed)));
    EXPECT_TRUE(std::isnan(signal)) << code;
    EXPECT_EQ(bench.volts, 0) << code;
  }
}

// Tests that a device which says, long after it was armed, that it is not is asked for zero volts while it
// holds some.
TEST(FrontEndLiesTest, NotArmedLongAfterwards) {
  for (const uint8_t state : {HYDRO_READY, HYDRO_IDLE, HYDRO_TRIPPED}) {
    DeviceBench bench;
    ASSERT_TRUE(bench.Connect());
    bench.Ticks(2000, 3);
    ASSERT_TRUE(bench.rig->faults().empty());
    ASSERT_EQ(bench.volts, -1.5F);
    bench.lie = [state](hydro_sample& sample) { sample.state = state; };
    bench.Ticks(5, 3);
    EXPECT_EQ(bench.volts, 0) << int{state};
    EXPECT_FALSE(bench.rig->faults().empty()) << int{state};
  }
}

// Tests that a sensor's fault lasts until ten good readings in a row, so that a loose contact does not switch
// the voltage on and off.
TEST(FrontEndLiesTest, LooseContact) {
  DeviceBench bench;
  int ticks = 0;
  Lied(&bench, [&ticks](hydro_sample& sample) {
    if (ticks++ % 5 == 0) sample.value[HYDRO_P1] = std::numeric_limits<float>::quiet_NaN();
  });
  for (int i = 0; i < 100; ++i) {
    bench.Ticks(1, 3);
    EXPECT_NE(bench.Fault("sensor_p1"), "") << i;
    EXPECT_EQ(bench.volts, 0) << i;
  }
  bench.lie = [](hydro_sample&) {};
  bench.Ticks(30, 3);
  EXPECT_EQ(bench.Fault("sensor_p1"), "");
}

// Tests that limits which are given narrow the ends, and that an input beyond any converter's is none.
TEST(FrontEndLiesTest, EndsFollowLimits) {
  DeviceBench slow(std::string(kFrontEndText) + "[limits]\nmotor_speed = 100\npressure = inf\n");
  Lied(&slow, [](hydro_sample& sample) { sample.value[HYDRO_MOTOR_SPEED] = 201; });
  EXPECT_THAT(slow.Fault("sensor_motor_speed"), HasSubstr("at most 200 rad/s, twice limits.motor_speed"));

  DeviceBench open(std::string(kFrontEndText) + "[limits]\npressure = inf\n");
  Lied(&open, [](hydro_sample& sample) { sample.value[HYDRO_P1] = 1e30F; });
  EXPECT_THAT(open.Fault("sensor_p1"), HasSubstr("at most 50000 psi, 100 V at the input"));
}

// Tests that each field holds what it may hold, and that fields which contradict each other are a fault, with
// zero volts.
TEST(FrontEndLiesTest, FieldsThatCannotBe) {
  struct Case {
    Falsify lie;
    const char* says;
  };
  const Case cases[] = {
      {[](auto& sample) { sample.state = 99; }, "its state is 99, allowed are 1 (ready), 2 (armed)"},
      {[](auto& sample) { sample.state = HYDRO_IDLE; }, "its state is 0"},
      {[](auto& sample) { sample.source = 7; }, "comes from source 7, allowed are 0 (zero), 1 (VOLTAGE)"},
      {[](auto& sample) { sample.saturated = 2; }, "says 2 for saturated"},
      {[](auto& sample) { sample.sensor_faults = 0x80; }, "names sensors that it does not have"},
      {[](auto& sample) { sample.state = HYDRO_READY; }, "acts by source 1 and that it is not armed"},
      {[](auto& sample) {
         sample.state = HYDRO_READY;
         sample.source = HYDRO_SOURCE_ZERO;
         sample.voltage = 0;
         sample.command_age = UINT32_MAX;
         sample.command_sequence = 0;
         sample.host_tick = 0;
       },
       "not armed any more, and counts no trip"},
      {[](auto& sample) { sample.command_age = UINT32_MAX; }, "acts by a command and that it has none"},
      {[](auto& sample) {
         sample.source = HYDRO_SOURCE_ZERO;
         sample.voltage = 0;
       },
       "has a command, and that it does not act by it"},
      {[](auto& sample) { sample.command_age = 250; },
       "its watchdog must trip after 250 (driver.watchdog_s)"},
      {[](auto& sample) { sample.faults_present = HYDRO_FAULT_SENSOR; }, "a sensor that is not credible"},
      {[](auto& sample) { sample.faults_present = 0x4000; }, "a fault that this version does not know"},
      {[](auto& sample) { sample.source = HYDRO_SOURCE_LAW; },
       "from its law (source 2), and its mode has none"},
      {[](auto& sample) { sample.transfer = 7; },
       "gives 0 for pressure_ref and 7 for transfer; allowed are 0"},
      {[](auto& sample) { sample.transfer = NAN; }, "gives 0 for pressure_ref and nan for transfer"},
      {[](auto& sample) { sample.pressure_ref = 100; }, "gives 100 for pressure_ref and 0 for transfer"},
      {[](auto& sample) { sample.pressure_ref = NAN; }, "gives nan for pressure_ref"},
      {[](auto& sample) { sample.faults_latched = 1; },
       "says that it is armed and that it has tripped: no valid command within driver.watchdog_s"},
      {[](auto& sample) { sample.value[HYDRO_ARM_SPEED] = 5; },
       "gives 5 for arm_speed, which it was not told to measure; allowed is NaN"},
      {[](auto& sample) { sample.arm_count = 3; },
       "gives a count of 3 for arm_angle, which it has no counter for; allowed is 0"},
  };
  for (const Case& each : cases) {
    DeviceBench bench;
    Lied(&bench, each.lie);
    EXPECT_THAT(bench.Fault("device_fault"), HasSubstr(each.says));
    bench.Tick(3);
    EXPECT_EQ(bench.volts, 0) << each.says;
    bench.lie = nullptr;
    bench.Ticks(200, 3);
    EXPECT_TRUE(bench.rig->faults().empty()) << each.says << ": " << bench.rig->faults().front().text;
  }
}

// Tests that a device which is not armed names no command, and that a voltage of zero is no end of its range.
TEST(FrontEndLiesTest, FieldsOfADeviceAtRest) {
  const std::pair<Falsify, const char*> cases[] = {
      {[](auto& sample) { sample.command_age = 3; }, "says that it has a command and that it is not armed"},
      {[](auto& sample) { sample.command_sequence = 9; },
       "says that it has no command, and names command 9 for tick 0"},
      {[](auto& sample) { sample.host_tick = 9; }, "names command 0 for tick 9"},
      {[](auto& sample) { sample.saturated = 1; }, "puts out zero volts and that its limits allow no more"},
  };
  for (const auto& [lie, says] : cases) {
    DeviceBench bench;
    ASSERT_TRUE(bench.Connect());
    for (int i = 0; i < 20; ++i) bench.Tick(0, /*obeys=*/false);
    ASSERT_TRUE(bench.rig->faults().empty()) << bench.rig->faults().front().text;
    bench.lie = lie;
    for (int i = 0; i < 2; ++i) bench.Tick(0, /*obeys=*/false);
    EXPECT_THAT(bench.Fault("device_fault"), HasSubstr(says));
  }
}

// Tests that a value of a signal that is not measured is passed on to nobody.
TEST(FrontEndLiesTest, ValueOfNoSensor) {
  DeviceBench bench;
  Lied(&bench, [](hydro_sample& sample) { sample.value[HYDRO_ARM_SPEED] = 5; });
  EXPECT_TRUE(std::isnan(bench.measured.arm_speed));
}

// Tests that "saturated" excuses what the limits explain that both sides know, driver.voltage.limit_V (8 V)
// and the range of the output, and nothing else; and that it may not be missing there.
TEST(FrontEndLiesTest, SaturatedWithoutALimit) {
  struct Case {
    double told;
    Falsify lie;
    const char* says;  // empty: no fault
  };
  const auto voltage = [](float volts, uint8_t saturated) {
    return [=](hydro_sample& sample) {
      if (sample.state == HYDRO_ARMED) sample.voltage = volts, sample.saturated = saturated;
    };
  };
  const Case cases[] = {
      {3, voltage(2, 1), "puts out 2 V; it was told 3 V"},
      {3, voltage(0, 1), "puts out 0 V; it was told 3 V"},
      {3, voltage(3, 1),
       "limits reduce its voltage (saturated is 1); it was asked for 3 V, and its limits are "
       "-5 and 5 V"},
      {7, voltage(5, 1), ""},
      {-7, voltage(-5, 1), ""},
      {7, voltage(5, 0), "limits do not reduce its voltage (saturated is 0); it was asked for 7 V"},
      {7, voltage(4, 1), "puts out 4 V; it was told 7 V, and its limits allow 5 V"},
      {7, voltage(0, 1), "puts out 0 V; it was told 7 V, and its limits allow 5 V"},
      {7, voltage(7, 1), "limits allow 5 V"},
      {7, voltage(-5, 1), "limits allow 5 V"},
  };
  for (const Case& each : cases) {
    DeviceBench bench;
    bench.facts.output_min_V =
        -2.5;  // at the terminal; V of eq. (1) are twice as many, and the other way round
    bench.facts.output_max_V = 2.5;
    hydro_device_begin(&bench.device, &bench.facts);
    ASSERT_TRUE(bench.Connect());
    bench.Ticks(150, each.told);
    ASSERT_TRUE(bench.rig->faults().empty()) << bench.rig->faults().front().text;
    bench.lie = each.lie;
    bench.Ticks(2, each.told);
    if (each.says[0] == '\0') {
      EXPECT_TRUE(bench.rig->faults().empty()) << bench.rig->faults().front().text;
      continue;
    }
    EXPECT_THAT(bench.Fault("output_differs"), HasSubstr(each.says));
    EXPECT_EQ(bench.volts, 0) << each.says;
  }
}

// Tests that a device which names a command that was never sent is at fault, whatever voltage it reports, in
// words that say what was found, what was sent and what it means.
TEST(FrontEndLiesTest, CommandThatWasNeverSent) {
  for (const uint32_t number : {100'000U, 0x80000000U, UINT32_MAX}) {
    for (const float volts : {3.0F, 0.0F}) {
      DeviceBench bench;
      Lied(&bench, [&](hydro_sample& sample) {
        if (sample.state == HYDRO_ARMED) sample.command_sequence = number, sample.voltage = volts;
      });
      EXPECT_THAT(
          bench.Fault("output_differs"),
          AllOf(HasSubstr(fmt::format("puts out {:.4g} V by command {}, which was never sent: the newest "
                                      "has number 15",
                                      volts, number)),
                HasSubstr("It obeys another program, or its firmware makes up the number; allowed is")))
          << number;
      EXPECT_EQ(bench.volts, 0) << number;
      EXPECT_EQ(bench.Fault("device_silent"), "") << number;
    }
  }
}

// Tests that a device's clock that stands still, runs backwards or jumps is a fault in the tick in which it
// is seen, and ends with it.
TEST(FrontEndLiesTest, ClockThatDoesNotGoOn) {
  struct Case {
    std::function<uint64_t(uint64_t)> tick;
    const char* says;
  };
  const Case cases[] = {
      {[](uint64_t) { return 1200; }, "clock stands still at tick 1200"},
      {[](uint64_t tick) { return 1'000'000 - tick; }, "clock runs backwards, from tick 99"},
      {[](uint64_t tick) { return tick * tick * tick; }, "clock jumps by"},
      {[](uint64_t tick) { return UINT64_MAX - tick; }, "clock runs backwards"},
      {[](uint64_t) { return 0; }, "clock stands still at tick 0"},
  };
  for (const Case& each : cases) {
    DeviceBench bench;
    Lied(
        &bench, [&](hydro_sample& sample) { sample.tick = each.tick(sample.tick); }, 4);
    EXPECT_THAT(bench.Fault("device_fault"), HasSubstr(each.says));
    EXPECT_EQ(bench.volts, 0);
    bench.lie = nullptr;
    bench.Ticks(200, 3);
    EXPECT_TRUE(bench.rig->faults().empty()) << bench.rig->faults().front().text;
    EXPECT_EQ(bench.volts, -1.5F);
  }
}

// Tests that a clock of another rate than the device states, as of a timer that was set up wrongly, is a
// fault within a few seconds, and that one which differs as quartz clocks do, or more, is none.
TEST(FrontEndLiesTest, ClockOfAnotherRate) {
  for (const double rate : {0.25, 0.5, 0.8, 0.999, 1.0, 1.3, 2.0, 10.0}) {
    DeviceBench bench;
    ASSERT_TRUE(bench.Connect());
    bench.Ticks(150, 3);
    const uint64_t begin = bench.device.tick;
    bench.lie = [&](hydro_sample& sample) {
      sample.tick =
          begin + static_cast<uint64_t>(std::llround(rate * static_cast<double>(sample.tick - begin)));
    };
    bool fault = false;
    for (int i = 0; i < 4000 && !fault; ++i) {
      bench.Tick(3);
      fault = bench.Fault("device_fault").find("ticks in a second of this computer's") != std::string::npos;
    }
    EXPECT_EQ(fault, rate < 0.55 || rate > 1.8) << rate;
    if (fault) {
      bench.Tick(3);
      EXPECT_EQ(bench.volts, 0);
    }
  }
}

// Tests that a count which is not that of its angle, or has moved faster than a motor can turn, is a fault of
// its sensor, and that no process gets the angle.
TEST(FrontEndLiesTest, CountsThatCannotBe) {
  DeviceBench bench;
  Lied(&bench, [](hydro_sample& sample) { sample.motor_count += 100000; });
  EXPECT_THAT(bench.Fault("sensor_motor_angle"),
              HasSubstr("motor_angle is 0, and its count of 100000 is 100"));
  EXPECT_TRUE(std::isnan(bench.measured.motor_angle));
  EXPECT_EQ(bench.volts, 0);

  DeviceBench jump;
  int by = 0;
  Lied(&jump, [&](hydro_sample& sample) {
    sample.motor_count += by;
    sample.value[HYDRO_MOTOR_ANGLE] += 0.001F * static_cast<float>(by);
  });
  EXPECT_TRUE(jump.rig->faults().empty());
  by = 40000;  // 40 rad in a millisecond
  jump.Ticks(2, 3);
  EXPECT_THAT(jump.Fault("sensor_motor_angle"),
              HasSubstr("has moved by 40 within 0.001 s; its speed is at most"));
  jump.Ticks(200, 3);
  EXPECT_TRUE(jump.rig->faults().empty()) << "it stays there";
}

// Tests that a device which suddenly says that it has another output, without a reset, is not the device with
// which the run began: it gets its settings anew.
TEST(FrontEndLiesTest, AnotherDevice) {
  DeviceBench bench;
  ASSERT_TRUE(bench.Connect());
  bench.Ticks(150, 3);
  bench.device.facts.output_max_V = 5;
  std::string faults;
  for (int i = 0; i < 300; ++i) {
    bench.Tick(3, /*obeys=*/false);
    if (i == 10) bench.rig->ZeroAtOnce();
    faults += bench.Fault("device_fault");
  }
  EXPECT_THAT(faults, HasSubstr("has gone to zero volts: it was sent a ZERO, as anyone may do"));
  EXPECT_THAT(faults,
              HasSubstr("has reset itself, or another one has taken its place: an output from -10 to 5 V "
                        "(an output from -10 to 10 V before); allowed is"));
  for (int i = 0; i < 200; ++i) bench.Tick(3, /*obeys=*/false);
  EXPECT_TRUE(bench.rig->faults().empty());
  bench.Ticks(50, 3);
  EXPECT_EQ(bench.volts, -1.5F);
}

// Until the rig has no fault, driven with 3 V; how many ticks that took, and the texts of its device_fault.
std::pair<int, std::string> UntilWell(DeviceBench* bench, int most = 2000) {
  std::string faults;
  int ticks = 0;
  do {
    bench->Tick(3);
    faults += bench->Fault("device_fault");
  } while (!bench->rig->faults().empty() && ++ticks < most);
  return {ticks, faults};
}

// Tests that a device which says in the run that it is one which does not fit the configuration is a fault
// that names what has changed, with zero volts even where it drives, and that the first one may come back.
TEST(FrontEndLiesTest, DeviceThatFitsNoMore) {
  struct Case {
    std::function<void(hydro_identity& identity)> change;
    const char* says;
  };
  const Case cases[] = {
      {[](auto& identity) { identity.tick_rate_hz = 4500; }, "4500 ticks/s (5000 ticks/s before)"},
      {[](auto& identity) { identity.modes = 2; }, "modes 2 (modes 3 before)"},
      {[](auto& identity) { identity.analog_inputs = 1; }, "1 analog inputs (8 analog inputs before)"},
      {[](auto& identity) {
         identity.counters = 0;
         std::strncpy(identity.board, "other\n", sizeof identity.board);
       },
       "board \"other\\x0a\" (board \"bench\" before), 0 counters (2 counters before)"},
      {[](auto& identity) { identity.output_max_V = NAN; },
       "an output from -10 to nan V (an output from -10 to 10 V before)"},
  };
  for (const Case& each : cases) {
    DeviceBench bench;
    ASSERT_TRUE(bench.Connect());
    bench.Ticks(150, 3);
    ASSERT_EQ(bench.volts, -1.5F);
    hydro_frame frame{};
    frame.kind = HYDRO_IDENTITY;
    frame.session = 0x1234;
    frame.sequence = 1;
    frame.body.identity = bench.rig->connection().identity();
    frame.body.identity.session_in_charge = 0x1234;
    each.change(frame.body.identity);
    uint8_t wire[HYDRO_WIRE_MAX];
    const size_t count = hydro_encode(&frame, wire);
    bench.SendToComputer(Bytes(wire, wire + count));
    bench.Tick(3);
    EXPECT_THAT(bench.Fault("device_fault"),
                AllOf(HasSubstr("is not the one with which the run began: "), HasSubstr(each.says)));
    EXPECT_EQ(bench.volts, 0) << each.says;
    EXPECT_NE(bench.device.state, HYDRO_ARMED) << each.says;
    const auto [ticks, faults] = UntilWell(&bench);
    EXPECT_LT(ticks, 300) << faults;
    EXPECT_THAT(faults, HasSubstr("has reset itself, or another one has taken its place: "));
    bench.Ticks(100, 3);
    EXPECT_EQ(bench.volts, -1.5F) << each.says;
  }
}

// Tests that a device which stays unfit stays at zero volts, with the fault, and ends no run.
TEST(FrontEndLiesTest, UnfitDeviceStays) {
  DeviceBench bench;
  ASSERT_TRUE(bench.Connect());
  bench.Ticks(150, 3);
  bench.facts.tick_rate_hz = 4500;
  bench.Reset();
  bench.Ticks(500, 3);
  for (int i = 0; i < 500; ++i) {
    bench.Tick(3);
    ASSERT_THAT(bench.Fault("device_fault"),
                HasSubstr("4500 ticks/s (5000 ticks/s before); it was sent a ZERO"));
    ASSERT_EQ(bench.volts, 0);
  }
  EXPECT_FALSE(bench.rig->Zero().accepted) << "nobody knows what its output holds";
}

// Tests that a device which goes on by an old command, whatever it is told, is sent a ZERO: in the tick that
// finds it, and a few ticks after any other fault; and that the driver does not wonder who has sent it.
TEST(FrontEndLiesTest, GoesOnByAnOldCommand) {
  for (const bool other_fault : {false, true}) {
    DeviceBench bench(settings::Replaced(kFrontEndText, "watchdog_s = 0.05", "watchdog_s = 1"));
    ASSERT_TRUE(bench.Connect());
    bench.Ticks(150, 3);
    const hydro_obeyed kept = bench.device.obeyed;
    bench.before_tick = [&](uint64_t) {
      if (bench.device.state != HYDRO_ARMED) return;
      bench.device.obeyed = kept;
      bench.device.obeyed.fresh = true;
    };
    if (other_fault) bench.lie = [](hydro_sample& sample) { sample.sensor_faults = 1; };
    int ticks = 0;
    while (bench.rig->faults().empty() && ++ticks < 200) bench.Tick(3);
    ASSERT_FALSE(bench.rig->faults().empty());
    EXPECT_LT(ticks, 110);
    bench.Ticks(other_fault ? 7 : 0, 3);
    EXPECT_EQ(bench.volts, 0) << other_fault;
    bench.Tick(3);
    EXPECT_EQ(bench.Fault("device_fault"), "");
  }
}

// Tests that a jump of the device's numbers that no loss explains is a fault of its own and no loss, that one
// which a loss explains is a loss, and that numbers which begin anew are a reset.
TEST(FrontEndLiesTest, NumbersThatJump) {
  for (const uint32_t by : {1000U, 5000U, 1'000'000U, 0x7ffffff0U}) {
    DeviceBench bench;
    ASSERT_TRUE(bench.Connect());
    bench.Ticks(150, 3);
    const int64_t lost = bench.rig->connection().counts().lost;
    bench.device.sent += by;
    bench.Ticks(3, 3);
    const FrameCounts& counts = bench.rig->connection().counts();
    const bool jump = by > 1000;  // a second of samples may have been lost on the way
    EXPECT_EQ(counts.jumps, jump ? 1 : 0) << by;
    EXPECT_EQ(counts.lost - lost, jump ? 0 : by);
    if (jump) {
      EXPECT_THAT(bench.Fault("device_fault"),
                  AllOf(HasSubstr("the numbers of the front end's frames jump from"),
                        HasSubstr("it cannot have sent so many meanwhile")));
      EXPECT_EQ(bench.volts, 0);
    }
    bench.Ticks(100, 3);
    EXPECT_TRUE(bench.rig->faults().empty()) << by;
    EXPECT_EQ(bench.volts, -1.5F) << by;
  }
  for (const uint32_t back : {200U, 0x80000000U}) {  // by more it is a jump ahead
    DeviceBench bench;
    ASSERT_TRUE(bench.Connect());
    bench.Ticks(150, 3);
    bench.device.sent -= back;
    bench.Ticks(120, 3);
    EXPECT_NE(bench.Fault("device_silent"), "") << back;
    const auto [ticks, faults] = UntilWell(&bench);
    EXPECT_LT(ticks, 400) << back;
    EXPECT_EQ(bench.rig->connection().counts().lost, 0) << back;
    if (back == 200) continue;  // two hundred numbers later it goes on as before
    EXPECT_THAT(faults, HasSubstr("has reset itself")) << back;
  }
}

// Tests that one frame with a number that the device has not reached is refused, and deafens nobody.
TEST(FrontEndLiesTest, OneFarNumber) {
  for (const uint32_t ahead : {5000U, 0x7fffffffU}) {
    DeviceBench bench;
    ASSERT_TRUE(bench.Connect());
    bench.Ticks(150, 3);
    const FrameCounts before = bench.rig->connection().counts();
    hydro_frame frame{};
    frame.kind = HYDRO_SAMPLE;
    frame.session = 0x1234;
    frame.sequence = bench.device.sent + ahead;
    frame.body.sample = bench.rig->connection().sample();
    uint8_t wire[HYDRO_WIRE_MAX];
    const size_t count = hydro_encode(&frame, wire);
    bench.SendToComputer(Bytes(wire, wire + count));
    for (int i = 0; i < 500; ++i) {
      bench.Tick(3);
      ASSERT_TRUE(bench.rig->faults().empty()) << bench.rig->faults().front().text;
    }
    const FrameCounts& after = bench.rig->connection().counts();
    EXPECT_EQ(after.refused - before.refused, 1);
    EXPECT_EQ(after.lost, before.lost);
    EXPECT_EQ(after.jumps, 0);
    EXPECT_EQ(bench.volts, -1.5F);
  }
}

// Tests that a trip has words even where the device gives no reason for it.
TEST(FrontEndLiesTest, TripWithoutAReason) {
  DeviceBench bench;
  Lied(
      &bench, [](hydro_sample& sample) { ++sample.trips; }, 1);
  bench.Tick(3);
  EXPECT_THAT(bench.Fault("device_fault"),
              HasSubstr("put out zero volts by itself: it does not say why (its faults_latched is 0)"));
}

}  // namespace
}  // namespace hydro::plant
