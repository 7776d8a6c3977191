#include "settings/driver_section.h"

#include "tests/settings/texts.h"

namespace hydro::settings {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using Source = SensorSection::Source;

// Line 15 of the whole is its first.
const char kDriver[] = R"([driver.voltage]
subdevice = 1
channel = 0
scale = 1
[driver.p1]
source = "analog"
subdevice = 0
channel = 0
scale = 500
[driver.p2]
source = "analog"
subdevice = 0
channel = 1
scale = 500
[driver.motor_speed]
source = "analog"
subdevice = 0
channel = 2
scale = 100
[driver.arm_angle]
source = "analog"
subdevice = 0
channel = 3
scale = 0.2
)";

std::string WithDriver(const std::string& driver = kDriver) { return kConfigText + driver; }

const char kEveryKey[] = R"([driver]
device = "/dev/comedi3"
settle_ns = 1500
[driver.voltage]
subdevice = 1
channel = 2
range = 3
reference = "common"
scale = -2.5
offset = 0.25
limit_V = 4
[driver.watchdog]
subdevice = 5
channel = 6
[driver.p1]
source = "analog"
subdevice = 7
channel = 8
range = 9
reference = "differential"
scale = 500
offset = -250
low_pass_hz = 400
minimum_V = 0.4
maximum_V = 4.6
[driver.p2]
source = "analog"
subdevice = 0
channel = 1
reference = "other"
scale = 100
[driver.motor_angle]
source = "counter"
subdevice = 3
channel = 1
scale = 0.0015
offset = 0.1
[driver.motor_speed]
source = "derivative"
low_pass_hz = 200
[driver.arm_angle]
source = "counter"
subdevice = 3
channel = 0
scale = 0.001
[driver.arm_speed]
source = "analog"
subdevice = 0
channel = 2
scale = 1
)";

// Tests that every key of [driver] reaches its field.
TEST(DriverSectionTest, ReadsEveryKey) {
  const StackConfig config = Parsed(WithDriver(kEveryKey));
  ASSERT_TRUE(config.driver);
  const DriverSection& driver = *config.driver;
  EXPECT_EQ(driver.device, "/dev/comedi3");
  EXPECT_EQ(driver.settle_ns, 1500);
  EXPECT_EQ(driver.voltage.line.subdevice, 1);
  EXPECT_EQ(driver.voltage.line.channel, 2);
  EXPECT_EQ(driver.voltage.range, 3);
  EXPECT_EQ(driver.voltage.reference, AnalogReference::kCommon);
  EXPECT_EQ(driver.voltage.scale, -2.5);
  EXPECT_EQ(driver.voltage.offset, 0.25);
  EXPECT_EQ(driver.voltage.limit_V, 4);
  ASSERT_TRUE(driver.watchdog);
  EXPECT_EQ(driver.watchdog->subdevice, 5);
  EXPECT_EQ(driver.watchdog->channel, 6);
  EXPECT_EQ(driver.p1.source, Source::kAnalog);
  EXPECT_EQ(driver.p1.line.subdevice, 7);
  EXPECT_EQ(driver.p1.line.channel, 8);
  EXPECT_EQ(driver.p1.range, 9);
  EXPECT_EQ(driver.p1.reference, AnalogReference::kDifferential);
  EXPECT_EQ(driver.p1.scale, 500);
  EXPECT_EQ(driver.p1.offset, -250);
  EXPECT_EQ(driver.p1.low_pass_hz, 400);
  EXPECT_EQ(driver.p1.minimum, 0.4);
  EXPECT_EQ(driver.p1.maximum, 4.6);
  EXPECT_EQ(driver.p2.reference, AnalogReference::kOther);
  EXPECT_EQ(driver.p2.scale, 100);
  EXPECT_TRUE(std::isnan(driver.p2.minimum) && std::isnan(driver.p2.maximum));
  EXPECT_EQ(driver.motor_angle.source, Source::kCounter);
  EXPECT_EQ(driver.motor_angle.scale, 0.0015);
  EXPECT_EQ(driver.motor_angle.offset, 0.1);
  EXPECT_EQ(driver.motor_speed.source, Source::kDerivative);
  EXPECT_EQ(driver.motor_speed.low_pass_hz, 200);
  EXPECT_EQ(driver.arm_angle.source, Source::kCounter);
  EXPECT_EQ(driver.arm_speed.source, Source::kAnalog);
  // The effective text, which goes into the log, says the same.
  EXPECT_EQ(Parsed(config.text).driver->p1.maximum, 4.6);
}

constexpr char kOwnDriver[] = R"(
[driver]
kind = "own"
device = "can0"
simulated_device = ["./drive", "5"]
[driver.own]
node = 5
[driver.voltage]
scale = 0.01
[driver.p1]
source = "analog"
input = "ai1"
scale = 500
minimum = 0.4
[driver.p2]
source = "analog"
scale = 500
[driver.motor_speed]
source = "analog"
scale = 1
[driver.arm_angle]
source = "counter"
input = "encoder"
scale = 0.001
)";

// Tests the keys of a device with a driver of the user's own, and that they survive in the effective text.
TEST(DriverSectionTest, OwnDriver) {
  const StackConfig config = Parsed(std::string(kConfigText) + kOwnDriver);
  for (const DriverSection& driver : {*config.driver, *Parsed(config.text).driver}) {
    EXPECT_EQ(driver.kind, DriverKind::kOwn);
    EXPECT_EQ(driver.device, "can0");
    EXPECT_THAT(driver.simulated_device, ::testing::ElementsAre("./drive", "5"));
    ASSERT_NE(driver.own.Find("node"), nullptr);
    EXPECT_EQ(driver.own.Find("node")->integer, 5);
    EXPECT_EQ(driver.p1.input, "ai1");
    EXPECT_EQ(driver.p1.minimum, 0.4);
    EXPECT_EQ(driver.p1.limit_suffix, "");
    EXPECT_EQ(driver.p2.input, "");
    EXPECT_EQ(driver.arm_angle.input, "encoder");
  }
  EXPECT_EQ(InputErrorOf([&] { CheckDriver(config, "./crane (driver)"); }), "");
  EXPECT_THAT(InputErrorOf([&] { CheckDriver(config); }),
              HasSubstr("driver.kind: found \"own\", allowed \"comedi\" or \"front_end\" with hydro-driver; "
                        "a driver of your own"));
  EXPECT_THAT(InputErrorOf([&] { CheckDriver(Parsed(WithDriver()), "./crane (driver)"); }),
              HasSubstr("driver.kind: found \"comedi\", allowed \"own\" with ./crane (driver)"));
}

// Tests that two pressures are not read from one input of a driver of the user's own, named or by default.
TEST(DriverSectionTest, OwnDriverWithOnePressure) {
  const std::string text = std::string(kConfigText) + kOwnDriver;
  const auto of = [&](const std::string& p1, const std::string& p2) {
    return InputErrorOf([&] {
      Parsed(Replaced(Replaced(text, "input = \"ai1\"", "input = \"" + p1 + "\""), "[driver.p2]\n",
                      "[driver.p2]\ninput = \"" + p2 + "\"\n"));
    });
  };
  EXPECT_THAT(of("ai1", "ai1"), HasSubstr("driver.p2.input: found \"ai1\", which [driver.p1] reads, too"));
  EXPECT_THAT(of("p2", ""), HasSubstr("driver.p2.input: found \"p2\""));
  EXPECT_EQ(of("p2", "p1"), "");
}

// Tests that what only a board has, and what only another device has, is refused with the other.
TEST(DriverSectionTest, KeysOfTheOtherKind) {
  const std::string own = std::string(kConfigText) + kOwnDriver;
  const std::vector<std::pair<std::string, std::string>> table = {
      {Replaced(own, "device = \"can0\"\n", ""),
       "driver.device: found nothing, allowed what the driver opens"},
      {Replaced(own, "kind = \"own\"", "kind = \"mine\""),
       "driver.kind: found \"mine\", allowed \"comedi\", \"front_end\" or \"own\""},
      {Replaced(own, "[driver.own]", "settle_ns = 5\n[driver.own]"),
       "driver: \"settle_ns\": found an unknown key"},
      {Replaced(own, "[driver.own]", "[driver.watchdog]"), "driver: \"watchdog\": found an unknown key"},
      {Replaced(own, "input = \"ai1\"", "subdevice = 0"), "driver.p1: \"subdevice\": found an unknown key"},
      {Replaced(own, "minimum = 0.4", "minimum_V = 0.4"), "driver.p1: \"minimum_V\": found an unknown key"},
      {Replaced(own, "minimum = 0.4", "minimum = 4\nmaximum = 4"),
       "driver.p1.minimum: found 4, allowed below maximum = 4"},
      {Replaced(own, "[\"./drive\", \"5\"]", "[\"./drive\", 5]"), "driver.simulated_device: found 5 in it"},
      {Replaced(own, "[driver.own]\nnode = 5", "own = 5"),
       "driver.own: found 5, allowed a section [driver.own]"},
      {WithDriver("[driver]\nown = 3\n"), "driver: \"own\": found an unknown key"},
  };
  for (const auto& [text, says] : table) {
    EXPECT_THAT(InputErrorOf([&, &text = text] { Parsed(text); }), HasSubstr(says)) << text;
  }
}

// Tests the defaults, and that a stack without [driver] has none.
TEST(DriverSectionTest, Defaults) {
  EXPECT_FALSE(Parsed(kConfigText).driver);
  const DriverSection driver = *Parsed(WithDriver()).driver;
  EXPECT_EQ(driver.device, "/dev/comedi0");
  EXPECT_EQ(driver.settle_ns, 0);
  EXPECT_TRUE(std::isinf(driver.voltage.limit_V));
  EXPECT_FALSE(driver.watchdog);
  EXPECT_EQ(driver.p1.low_pass_hz, 0);
  EXPECT_EQ(driver.motor_angle.source, Source::kNone);
  EXPECT_EQ(driver.arm_speed.source, Source::kNone);
}

// Tests that a motor of a real rig does not start again unasked, unless the configuration says so.
TEST(DriverSectionTest, RearmIsExplicit) {
  EXPECT_EQ(Parsed(kConfigText).limits.rearm, Rearm::kRestart);
  EXPECT_EQ(Parsed(WithDriver()).limits.rearm, Rearm::kExplicit);
  EXPECT_EQ(Parsed(WithDriver() + "[limits]\nrearm = \"restart\"\n").limits.rearm, Rearm::kRestart);
}

// Tests that each malformed [driver] is refused on one line with its place and key.
TEST(DriverSectionTest, Errors) {
  const auto changed = [](const std::string& from, const std::string& to) {
    return Replaced(WithDriver(), from, to);
  };
  const std::vector<std::pair<std::string, std::string>> table = {
      {kConfigText + std::string("[driver]\n"), "driver.voltage: found nothing, allowed a section"},
      {kConfigText + std::string("[driver]\nboard = 1\n"), "driver: \"board\": found an unknown key"},
      {WithDriver("[driver]\ndevice = 3\n"), "driver.device: found 3, allowed a string"},
      {WithDriver("[driver]\nsettle_ns = 100000\n"),
       "driver.settle_ns: found 100000, allowed a whole number"},
      {changed("[driver.p1]", "[driver.p3]"), "driver: \"p3\": found an unknown key, allowed"},
      {changed("[driver.p1]", "[driver.p1]\ngain = 1"),
       "stack.toml:20: driver.p1: \"gain\": found an unknown key"},
      {changed("scale = 1\n", ""), "driver.voltage.scale: found nothing"},
      {changed("scale = 1\n", "scale = 0\n"), "stack.toml:18: driver.voltage.scale: found 0"},
      {changed("scale = 1\n", "scale = 1\nlimit_V = -1\n"), "driver.voltage.limit_V: found -1"},
      {changed("scale = 1\n", "scale = 1\nreference = \"earth\"\n"),
       "driver.voltage.reference: found \"earth\""},
      {changed("channel = 1\n", ""), "driver.p2.channel: found nothing, allowed the number of the channel"},
      {changed("channel = 1\n", "channel = -1\n"), "driver.p2.channel: found -1"},
      {changed("channel = 1\n", "channel = 0\n"),
       "driver.p2.channel: found 0, which [driver.p1] reads, too, allowed another than that of p1"},
      {changed("channel = 1\n", "channel = 1\nlow_pass_hz = -5\n"), "driver.p2.low_pass_hz: found -5"},
      {changed("channel = 1\n", "channel = 1\nminimum_V = 2\nmaximum_V = 2\n"),
       "driver.p2.minimum_V: found 2, allowed below maximum_V = 2"},
      {changed("source = \"analog\"\n", "source = \"counter\"\n"),
       "driver.p1.source: found \"counter\", allowed \"analog\""},
      {changed("source = \"analog\"\n", ""), "driver.p1: \"subdevice\": found an unknown key"},
      {WithDriver() + "[driver.arm_speed]\nsource = \"derivative\"\nscale = 2\n",
       "driver.arm_speed: \"scale\": found an unknown key"},
      {WithDriver() + "[driver.motor_angle]\nsource = \"counter\"\nsubdevice = 3\nchannel = 0\nscale = "
                      "0.001\nminimum_V = 1\n",
       "driver.motor_angle: \"minimum_V\": found an unknown key"},
      {WithDriver() + "[driver.watchdog]\nsubdevice = 2\n", "driver.watchdog.channel: found nothing"},
      {changed("source = \"analog\"\nsubdevice = 0\nchannel = 2\nscale = 100", "source = \"derivative\""),
       "driver.motor_speed: found source = \"derivative\" without [driver.motor_angle]"},
      {WithDriver("[[process]]\nprogram = \"hydro-plant\"\n[[process]]\nprogram = \"hydro-driver\"\n"),
       "process.program: found hydro-driver beside hydro-plant, allowed one of the two"},
  };
  for (const auto& row : table) {
    const std::string& text = row.first;
    const std::string error = InputErrorOf([&] { Parsed(text); });
    EXPECT_THAT(error, AllOf(HasSubstr("stack.toml"), HasSubstr(row.second))) << text;
    EXPECT_EQ(error.find('\n'), std::string::npos);
  }
}

// Tests what else a stack needs before a board may be driven, each with its key.
TEST(DriverSectionTest, WhatADriverNeeds) {
  const auto error = [](const std::string& text) { return InputErrorOf([&] { CheckDriver(Parsed(text)); }); };
  EXPECT_EQ(error(WithDriver()), "");
  EXPECT_THAT(error(kConfigText), HasSubstr("stack.toml: driver: found nothing"));
  EXPECT_THAT(error(WithDriver("[time]\nmode = \"lockstep\"\n") + kDriver),
              HasSubstr("time.mode: found \"lockstep\", allowed \"realtime\" with hydro-driver"));
  EXPECT_THAT(error(WithDriver("[time]\nspeed = 2\n") + kDriver),
              HasSubstr("time.speed: found 2, allowed 1"));
  const std::string no_angle = WithDriver().substr(0, WithDriver().find("[driver.arm_angle]"));
  EXPECT_THAT(error(no_angle), HasSubstr("driver.arm_angle: found nothing"));
  EXPECT_EQ(error(Replaced(no_angle, "\"arm_angle\"", "\"pressure\"")), "");
  EXPECT_THAT(error(Replaced(WithDriver(), "[pressure]", "[pressure]\narm_speed_feedforward = true")),
              HasSubstr("driver.arm_speed: found nothing"));
}

}  // namespace
}  // namespace hydro::settings
