// [driver] with kind = "front_end".

#include "settings/driver_section.h"
#include "tests/settings/texts.h"

namespace hydro::settings {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr char kFrontEndSection[] = R"([driver]
kind = "front_end"
url = "serial:/dev/ttyACM0?baud=2000000"
mode = "loop_on_device"
watchdog_s = 0.02
read_back_tolerance_V = 0.1
[driver.voltage]
scale = -2
offset = 0.5
limit_V = 4
[driver.p1]
source = "analog"
channel = 3
scale = 500
minimum_V = 0.4
maximum_V = 4.6
[driver.p2]
source = "analog"
channel = 1
scale = 500
[driver.motor_angle]
source = "counter"
channel = 1
counter_bits = 16
scale = 0.001
[driver.motor_speed]
source = "derivative"
low_pass_hz = 200
[driver.arm_angle]
source = "analog"
channel = 0
scale = 0.2
)";

StackConfig WithFrontEnd(const std::string& driver) { return Parsed(kConfigText + driver); }

// Tests that every key of a front end reaches its field.
TEST(FrontEndSectionTest, ReadsEveryKey) {
  const StackConfig config = WithFrontEnd(kFrontEndSection);
  ASSERT_TRUE(config.driver);
  const DriverSection& driver = *config.driver;
  EXPECT_EQ(driver.kind, DriverKind::kFrontEnd);
  EXPECT_EQ(driver.front_end.url, "serial:/dev/ttyACM0?baud=2000000");
  EXPECT_EQ(driver.front_end.address.path, "/dev/ttyACM0");
  EXPECT_EQ(driver.front_end.address.baud, 2000000);
  EXPECT_EQ(driver.front_end.mode, FrontEndMode::kLoopOnDevice);
  EXPECT_EQ(driver.front_end.watchdog_s, 0.02);
  EXPECT_EQ(driver.front_end.read_back_tolerance_V, 0.1);
  EXPECT_EQ(driver.voltage.scale, -2);
  EXPECT_EQ(driver.p1.line.channel, 3);
  EXPECT_EQ(driver.p1.minimum, 0.4);
  EXPECT_EQ(driver.motor_angle.counter_bits, 16);
  EXPECT_EQ(config.limits.rearm, Rearm::kExplicit);
  EXPECT_EQ(InputErrorOf([&] { CheckDriver(config); }), "");
  // The effective text, which goes into the log, says the same.
  EXPECT_EQ(Parsed(config.text).driver->front_end.url, driver.front_end.url);
}

// Tests the defaults.
TEST(FrontEndSectionTest, Defaults) {
  std::string text = kFrontEndSection;
  for (const char* line : {"mode = \"loop_on_device\"\n", "watchdog_s = 0.02\n",
                           "read_back_tolerance_V = 0.1\n", "counter_bits = 16\n"}) {
    text = Replaced(text, line, "");
  }
  const DriverSection driver = *WithFrontEnd(text).driver;
  EXPECT_EQ(driver.front_end.mode, FrontEndMode::kRemoteIo);
  EXPECT_FALSE(driver.front_end.watchdog_s);
  EXPECT_EQ(driver.front_end.read_back_tolerance_V, 0);
  EXPECT_EQ(driver.motor_angle.counter_bits, 32);
}

// Tests that each malformed section is refused on one line with its place and key.
TEST(FrontEndSectionTest, Errors) {
  const std::string text = kFrontEndSection;
  const std::pair<std::string, std::string> table[] = {
      {Replaced(text, "url = \"serial:/dev/ttyACM0?baud=2000000\"\n", ""),
       "driver.url: found nothing, allowed the address"},
      {Replaced(text, "serial:/dev/ttyACM0?baud=2000000", "ttyACM0"),
       "driver.url: found \"ttyACM0\", allowed serial:/dev/NAME"},
      {Replaced(text, "baud=2000000", "baud=123456"), "allowed baud=RATE with one of 9600"},
      {Replaced(text, "loop_on_device", "loop"), "driver.mode: found \"loop\", allowed \"remote_io\""},
      {Replaced(text, "watchdog_s = 0.02", "watchdog_s = 0"), "driver.watchdog_s: found 0"},
      {Replaced(text, "watchdog_s = 0.02", "watchdog_s = 2"), "driver.watchdog_s: found 2"},
      {Replaced(text, "watchdog_s = 0.02", "device = \"/dev/comedi0\""), "\"device\": found an unknown key"},
      {Replaced(text, "channel = 3\n", ""),
       "driver.p1.channel: found nothing, allowed the number of the front end's analog input"},
      {Replaced(text, "channel = 3\n", "channel = 3\nsubdevice = 0\n"),
       "\"subdevice\": found an unknown key"},
      {Replaced(text, "counter_bits = 16", "counter_bits = 33"), "driver.motor_angle.counter_bits: found 33"},
      {Replaced(text, "channel = 3\n", "channel = 3\ncounter_bits = 16\n"),
       "\"counter_bits\": found an unknown key"},
      {text + "[driver.watchdog]\nchannel = 0\n", "\"watchdog\": found an unknown key"},
      {text + "[[process]]\nprogram = \"hydro-driver\"\n[[process]]\nprogram = \"hydro-pressure-ctrl\"\n",
       "found hydro-pressure-ctrl with driver.mode = \"loop_on_device\", allowed a stack without it"},
  };
  for (const auto& row : table) {
    const std::string& document = row.first;
    const std::string error = InputErrorOf([&] { WithFrontEnd(document); });
    EXPECT_THAT(error, AllOf(HasSubstr("stack.toml"), HasSubstr(row.second))) << document;
    EXPECT_EQ(error.find('\n'), std::string::npos);
  }
}

}  // namespace
}  // namespace hydro::settings
