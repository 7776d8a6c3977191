#include "plant/driver/device_rig.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spdlog/fmt/fmt.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <functional>
#include <limits>
#include <utility>

#include "base/input_error.h"
#include "plant/driver/check_sensors.h"
#include "tests/stack_fixture.h"

namespace hydro::plant {
namespace {

using namespace std::chrono_literals;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using Source = settings::SensorSection::Source;

// What a device does, in memory that its guardian shares.
struct Shared {
  double output = 7;  // as a program that crashed has left it
  int zeros = 0;
  bool refuses_zero = false;
  pid_t refuses_zero_of = -1;  // of that process only: its own descriptor has gone
};

// A device whose readings the test sets, and which measures now unless told otherwise.
class FakeDevice : public Device {
 public:
  FakeDevice(Shared* shared, const bus::Clock& clock) : shared_(shared), clock_(clock) {
    readings.inputs.assign(4, {.value = 1});
  }

  DeviceDescription Describe() const override {
    return {.name = "fake",
            .inputs = {{.name = "pressures1", .unit = "mA", .low = 0, .high = 22},
                       {.name = "p2", .unit = "mA", .low = 0, .high = 22},
                       {.name = "motor_angle", .kind = DeviceInput::Kind::kCount, .highest_count = 0xffff},
                       {.name = "motor_speed", .unit = "mA"}},
            .output = described_output,
            .files = files};
  }
  void Read(DeviceReadings& into) override {
    if (!unfit.empty()) throw InputError(unfit);
    if (!silent && (!answers_when_driven || driven_)) {
      for (Reading& reading : readings.inputs) reading.at = clock_.Now();
    }
    into = readings;
    for (Reading& reading : into.inputs) reading.at += ahead;
    if (tells_output) into.output = {lies.value_or(shared_->output), clock_.Now()};
  }
  void Drive(double output) override {
    shared_->output = output;
    driven_ = true;
  }
  bool Zero(double output) noexcept override {
    if (shared_->refuses_zero || shared_->refuses_zero_of == getpid()) return false;
    shared_->output = output;
    ++shared_->zeros;
    return true;
  }
  double ReadBack() noexcept override { return lies.value_or(shared_->output); }

  DeviceOutput described_output{.unit = "mA", .low = -20, .high = 20, .tolerance = 0.1};
  std::vector<int> files;
  DeviceReadings readings;
  bus::Clock::Duration ahead{};  // of the clock, in what it says of its readings' times
  bool silent = false;
  std::string unfit;
  bool answers_when_driven = false;
  bool tells_output = false;
  std::optional<double> lies;

 private:
  Shared* shared_;
  const bus::Clock& clock_;
  bool driven_ = false;
};

class DeviceRigTest : public ::testing::Test {
 protected:
  DeviceRigTest()
      : shared_(new (mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0))
                    Shared) {
    config_ = testing::SmallStack();
    config_.file = "rig.toml";
    config_.limits.stale_input_s = 0.1;
    settings::DriverSection driver;
    driver.kind = settings::DriverKind::kOwn;
    driver.voltage.scale = 0.5;  // V per mA
    driver.p1 = Analog(100, "pressures1");
    driver.p2 = Analog(100, "");
    driver.motor_speed = Analog(10, "");
    config_.driver = driver;
  }
  ~DeviceRigTest() override { munmap(shared_, sizeof(Shared)); }

  static settings::SensorSection Analog(double scale, const std::string& input) {
    settings::SensorSection section;
    section.source = Source::kAnalog;
    section.input = input;
    section.scale = scale;
    return section;
  }

  std::unique_ptr<DeviceRig> Open(const std::function<void(FakeDevice&)>& change = nullptr) {
    auto device = std::make_unique<FakeDevice>(shared_, clock_);
    device_ = device.get();
    if (change) change(*device);
    return std::make_unique<DeviceRig>(config_, clock_, std::move(device));
  }

  std::string OpenError(const std::function<void(FakeDevice&)>& change = nullptr) {
    try {
      Open(change);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  model::Measurement Read(DeviceRig& rig, std::chrono::milliseconds later = 1ms) {
    clock_.AdvanceTo(clock_.Now() + later);
    return rig.Read(++tick_);
  }

  static std::vector<std::string> Codes(const DeviceRig& rig) {
    std::vector<std::string> codes;
    for (const RigFault& fault : rig.faults()) codes.push_back(fault.code);
    return codes;
  }

  Shared* shared_;
  settings::StackConfig config_;
  bus::SimulatedClock clock_;
  FakeDevice* device_ = nullptr;
  int64_t tick_ = 0;
};

// Tests scales, inputs by their name or the signal's, and zero volts at the beginning and the end, also with
// an offset.
TEST_F(DeviceRigTest, ScalesAndZero) {
  config_.driver->voltage.offset = 1;  // V at 0 mA
  auto rig = Open();
  EXPECT_EQ(shared_->output, -2);
  device_->readings.inputs[0].value = 3;
  const model::Measurement measured = Read(*rig);
  EXPECT_EQ(measured.p1, 300);
  EXPECT_EQ(measured.p2, 100);
  EXPECT_TRUE(std::isnan(measured.arm_angle));
  EXPECT_THAT(rig->faults(), IsEmpty());
  EXPECT_EQ(rig->Drive(4), 4);
  EXPECT_EQ(shared_->output, 6);
  EXPECT_EQ(rig->Drive(30), 11) << "what the output reaches: 20 mA";
  EXPECT_EQ(rig->Drive(std::nan("")), 0);
  EXPECT_EQ(rig->Zero().voltage, 0);
  rig->Drive(5);
  rig.reset();
  EXPECT_EQ(shared_->output, -2);
}

// Tests that an output whose range is none, with which no limit would hold, and a file that is not open, with
// which no guardian could write a zero, are refused before anything is put out.
TEST_F(DeviceRigTest, DescriptionsThatCannotBe) {
  for (const auto& range : {std::pair<double, double>{NAN, NAN}, {-20, NAN}, {20, -20}, {0, 0}}) {
    const auto describe = [&](FakeDevice& device) {
      device.described_output.low = range.first;
      device.described_output.high = range.second;
    };
    EXPECT_THAT(OpenError(describe),
                HasSubstr("as its driver describes it, allowed one whose lower end is below"))
        << range.first << " " << range.second;
  }
  for (const int file : {-1, 1'000'000}) {
    EXPECT_THAT(
        OpenError([&](FakeDevice& device) {
          device.files = {STDERR_FILENO, file};
        }),
        HasSubstr("driver.device: found the descriptor " + std::to_string(file) + ", which is not open"));
  }
  EXPECT_EQ(shared_->zeros, 0);
}

// Tests that a driver that gives fewer or more readings than it has described ends the run, in words that say
// so.
TEST_F(DeviceRigTest, ReadingsThatAreMissing) {
  for (const size_t count : {0U, 1U, 5U}) {
    const auto rig = Open();
    Read(*rig);
    device_->readings.inputs.resize(count);
    try {
      Read(*rig);
      ADD_FAILURE() << count;
    } catch (const DeviceError& error) {
      EXPECT_EQ(error.what(),
                fmt::format("fake gives {} readings; allowed are 4, one for each input that its "
                            "driver describes",
                            count));
    }
  }
}

// Tests that a reading from the future, of a driver that takes another clock, is a fault, and hides no
// silence of its device.
TEST_F(DeviceRigTest, ReadingsFromTheFuture) {
  const auto rig = Open();
  Read(*rig);
  ASSERT_THAT(Codes(*rig), IsEmpty());
  device_->ahead = 1h;
  EXPECT_TRUE(std::isnan(Read(*rig).p1));
  EXPECT_THAT(Codes(*rig), ElementsAre("sensor_p1", "sensor_p2", "sensor_motor_speed"));
  EXPECT_THAT(rig->faults().front().text,
              HasSubstr("p1 has a reading from 3600 s in the future; allowed is"));
  Read(*rig, 101ms);
  EXPECT_EQ(Codes(*rig).front(), "device_silent") << "nothing that counts has come since";
}

// Tests that readings which are ahead by less than the patience are the same fault, and that those which a
// clock's error explains are none, and hide silence for no longer than that.
TEST_F(DeviceRigTest, ReadingsALittleAhead) {
  const auto rig = Open();
  Read(*rig);
  device_->ahead = 90ms;
  Read(*rig);
  EXPECT_THAT(Codes(*rig), ElementsAre("sensor_p1", "sensor_p2", "sensor_motor_speed"));
  device_->ahead = 1ms;
  for (int i = 0; i < 20; ++i) EXPECT_EQ(Read(*rig).p1, 100);
  EXPECT_THAT(Codes(*rig), IsEmpty());
  device_->silent = true;
  Read(*rig, 102ms);
  EXPECT_EQ(Codes(*rig).front(), "device_silent");
}

// Tests that a run that begins late, when the loops have kept the driver waiting, begins with a reading of
// now of a device that answers only to what is put out.
TEST_F(DeviceRigTest, LateBeginning) {
  const auto rig = Open();
  device_->answers_when_driven = true;
  EXPECT_EQ(Read(*rig, 10s).p1, 100);
  EXPECT_THAT(Codes(*rig), IsEmpty());
  EXPECT_EQ(shared_->output, 0);
}

// Tests that a device that says nothing new for limits.stale_input_s is a fault with no readings, and none of
// each sensor, and that both end with its first answer.
TEST_F(DeviceRigTest, SilentDevice) {
  const auto rig = Open();
  Read(*rig);
  device_->silent = true;
  EXPECT_EQ(Read(*rig, 100ms).p1, 100) << "what was measured 100 ms ago";
  EXPECT_THAT(Codes(*rig), IsEmpty());
  const model::Measurement none = Read(*rig);
  for (const double signal : {none.p1, none.p2, none.motor_speed}) EXPECT_TRUE(std::isnan(signal));
  EXPECT_THAT(Codes(*rig), ElementsAre("device_silent"));
  EXPECT_THAT(rig->faults()[0].text, HasSubstr("nothing has come from fake for longer than 0.1 s"));
  EXPECT_NEAR(rig->faults()[0].value, 0.101, 1e-9);
  device_->silent = false;
  EXPECT_EQ(Read(*rig).p1, 100);
  EXPECT_THAT(Codes(*rig), IsEmpty());
}

// Tests that one input that grows old, of a device that still answers, is that sensor's fault.
TEST_F(DeviceRigTest, OneSilentInput) {
  const auto rig = Open();
  Read(*rig);
  device_->silent = true;
  const auto old = device_->readings.inputs[1].at;
  clock_.AdvanceTo(clock_.Now() + 200ms);
  for (Reading& reading : device_->readings.inputs) reading.at = clock_.Now();
  device_->readings.inputs[1].at = old;
  const model::Measurement measured = Read(*rig);
  EXPECT_EQ(measured.p1, 100);
  EXPECT_TRUE(std::isnan(measured.p2));
  EXPECT_THAT(Codes(*rig), ElementsAre("sensor_p2"));
  EXPECT_THAT(rig->faults()[0].text, HasSubstr("p2 has no reading that is newer than 0.1 s"));
}

// Tests that NaN, infinity and what is no count are faults of that sensor, which last for ten good readings
// more.
TEST_F(DeviceRigTest, NoNumber) {
  config_.driver->motor_angle.source = Source::kCounter;
  const auto rig = Open();
  for (const auto& [index, value, code] : {std::tuple{0, std::nan(""), "sensor_p1"},
                                           {1, INFINITY, "sensor_p2"},
                                           {2, 0.5, "sensor_motor_angle"},
                                           {2, -1.0, "sensor_motor_angle"},
                                           {2, 65536.0, "sensor_motor_angle"},
                                           {2, std::nan(""), "sensor_motor_angle"}}) {
    device_->readings.inputs[index].value = value;
    Read(*rig);
    EXPECT_THAT(Codes(*rig), ElementsAre(code)) << value;
    device_->readings.inputs[index].value = 1;
    for (int i = 0; i < 9; ++i) Read(*rig);
    EXPECT_THAT(Codes(*rig), ElementsAre(code)) << value;
    Read(*rig);
    EXPECT_THAT(Codes(*rig), IsEmpty()) << value;
  }
}

// Tests the limits of a reading in the input's own unit, which the text names.
TEST_F(DeviceRigTest, LimitsInTheInputsUnit) {
  config_.driver->p1.minimum = 4;
  const auto rig = Open();
  device_->readings.inputs[0].value = 3.5;
  EXPECT_TRUE(std::isnan(Read(*rig).p1));
  EXPECT_THAT(rig->faults()[0].text,
              HasSubstr("p1 reads 3.5 mA, the least allowed is 4 mA (driver.p1.minimum)"));
  device_->readings.inputs[1].value = 22;
  Read(*rig);
  EXPECT_THAT(rig->faults()[1].text, HasSubstr("p2 reads 22 mA, an end of its input range"));
}

// Tests that an input without ends of its own, and a rate, have those of the machine: what none gives is a
// fault of its sensor, and gives no signal.
TEST_F(DeviceRigTest, ReadingsThatNoMachineGives) {
  const auto rig = Open();
  for (const double value : {1e30, -1e30, 3000.0}) {
    device_->readings.inputs[3].value = value;  // motor_speed
    EXPECT_TRUE(std::isnan(Read(*rig).motor_speed));
    EXPECT_THAT(Codes(*rig), ElementsAre("sensor_motor_speed"));
    EXPECT_THAT(rig->faults()[0].text, HasSubstr("rad/s, ten times T_pmax/b")) << value;
    device_->readings.inputs[3].value = 100;
    for (int i = 0; i < 10; ++i) EXPECT_EQ(Read(*rig).motor_speed, 1000);
    EXPECT_THAT(Codes(*rig), IsEmpty());
  }
}

TEST_F(DeviceRigTest, PressuresThatNoMachineGives) {
  config_.driver->p2.scale = 1e4;
  const auto rig = Open();
  EXPECT_TRUE(std::isnan(Read(*rig).p2));
  EXPECT_THAT(rig->faults()[0].text,
              HasSubstr("p2 is 10000 psi, which is not credible: allowed is at most 4000 "
                        "psi, twice limits.pressure"));
}

TEST_F(DeviceRigTest, RatesThatNoMachineGives) {
  config_.driver->motor_angle.source = Source::kCounter;
  config_.driver->motor_angle.scale = 0.01;
  config_.driver->motor_speed.source = Source::kDerivative;
  const auto rig = Open();
  Read(*rig);
  device_->readings.inputs[2].value += 10;
  EXPECT_NEAR(Read(*rig).motor_speed, 100, 1e-6);
  device_->readings.inputs[2].value += 16000;  // less than a quarter of the counter's range
  EXPECT_TRUE(std::isnan(Read(*rig).motor_speed));
  EXPECT_THAT(Codes(*rig), ElementsAre("sensor_motor_speed"));
}

// Tests that what the device says is wrong with itself is a fault as long as it says so.
TEST_F(DeviceRigTest, FaultOfTheDevice) {
  const auto rig = Open();
  device_->readings.fault = "emergency 0x2310";
  EXPECT_EQ(Read(*rig).p1, 100);
  EXPECT_THAT(Codes(*rig), ElementsAre("device_fault"));
  EXPECT_THAT(rig->faults()[0].text, HasSubstr("fake reports emergency 0x2310"));
  device_->readings.fault.clear();
  Read(*rig);
  EXPECT_THAT(Codes(*rig), IsEmpty());
}

// Tests that what a driver takes in the run for an error of the configuration, as a device that says
// something else of itself than at the start, ends the run as an error of the device, and is no bad input.
TEST_F(DeviceRigTest, DeviceThatFitsNoMore) {
  const auto rig = Open();
  Read(*rig);
  device_->unfit = "rig.toml: driver.own.node: found 7, allowed 5";
  try {
    Read(*rig);
    ADD_FAILURE() << "no error";
  } catch (const RigError& error) {
    EXPECT_EQ(error.code(), "board_error");
    EXPECT_STREQ(error.what(), device_->unfit.c_str());
  }
}

// Tests that an output that reads back other than anything put out lately is a fault; that one which follows
// late is none; and that the fault ends when both agree.
TEST_F(DeviceRigTest, OutputDiffers) {
  const auto rig = Open();
  device_->tells_output = true;
  for (int i = 0; i < 100; ++i) {
    device_->lies = rig->Drive(5) / 0.5 * std::min(1.0, i / 50.0);  // a slow amplifier
    if (i == 0) rig->Drive(0);
    Read(*rig);
    ASSERT_THAT(Codes(*rig), IsEmpty()) << i;
    rig->Drive(5);
  }
  device_->lies = 13;
  Read(*rig);
  EXPECT_THAT(Codes(*rig), ElementsAre("output_differs"));
  EXPECT_THAT(rig->faults()[0].text, HasSubstr("the output of fake reads back 13 mA; 10 mA was put out"));
  device_->lies.reset();
  Read(*rig);
  EXPECT_THAT(Codes(*rig), IsEmpty());
  // No number that can be, and one without a time, which is of now.
  device_->lies = std::numeric_limits<double>::infinity();
  Read(*rig);
  EXPECT_THAT(Codes(*rig), ElementsAre("output_differs"));
  device_->tells_output = false;
  device_->readings.output = {13, {}};
  clock_.AdvanceTo(clock_.Now() + 10s);
  rig->Drive(5);
  Read(*rig);
  EXPECT_THAT(Codes(*rig), ElementsAre("output_differs"));
  device_->tells_output = true;
  // Zero volts that have no effect.
  device_->lies = 10;
  for (int i = 0; i < 101; ++i) {
    rig->Drive(0);
    Read(*rig);
  }
  EXPECT_THAT(Codes(*rig), ElementsAre("output_differs"));
}

// Tests that an input which the device does not have is bad input that names those which it has, of that
// kind.
TEST_F(DeviceRigTest, InputsThatAreNotThere) {
  config_.driver->p2.input = "p3";
  EXPECT_THAT(OpenError(),
              HasSubstr("rig.toml: driver.p2.input: found \"p3\", allowed \"pressures1\", \"p2\""));
  config_.driver->p2.input = "motor_angle";
  EXPECT_THAT(OpenError(), HasSubstr("driver.p2.input: found \"motor_angle\", allowed \"pressures1\""));
  config_.driver->p2.input = "";
  config_.driver->voltage.offset = 11;
  EXPECT_THAT(OpenError(),
              HasSubstr("driver.voltage.offset: found 11, allowed one with which zero volts are within "
                        "the output's range, -20 to 20 mA"));
  EXPECT_EQ(shared_->output, 7) << "nothing was put out";
}

// Tests that a device that takes no zero is not driven, and says so.
TEST_F(DeviceRigTest, RefusedZero) {
  shared_->refuses_zero = true;
  try {
    Open();
    FAIL();
  } catch (const RigError& error) {
    EXPECT_EQ(error.code(), "board_error");
    EXPECT_THAT(error.what(), HasSubstr("fake does not accept zero volts"));
  }
}

// Tests that an output which still holds something after it took the zero has not taken it.
TEST_F(DeviceRigTest, OutputThatStays) {
  const auto rig = Open();
  EXPECT_TRUE(rig->Zero().accepted);
  int told = 0;
  rig->set_when_late([&] { ++told; });
  device_->lies = 3;
  const OutputLeft left = rig->Zero();
  EXPECT_EQ(told, 1) << "the loops hear why no states come before they miss them";
  EXPECT_FALSE(left.accepted);
  EXPECT_EQ(left.voltage, 1.5);
  device_->lies = -std::numeric_limits<double>::infinity();
  EXPECT_FALSE(rig->Zero().accepted);
  device_->lies = std::nan("");  // it does not say
  EXPECT_TRUE(rig->Zero().accepted);
  device_->lies.reset();
}

// Tests that what a device read back before it fell silent is held against nothing that was put out since.
TEST_F(DeviceRigTest, OldReadBack) {
  const auto rig = Open();
  device_->tells_output = true;
  rig->Drive(5);
  Read(*rig);
  device_->tells_output = false;  // the reading stays as it was
  device_->readings.output = {10, clock_.Now()};
  device_->silent = true;
  for (int i = 0; i < 300; ++i) {
    rig->Drive(0);
    Read(*rig);
  }
  EXPECT_THAT(Codes(*rig), ElementsAre("device_silent"));
}

// Tests that the guardian zeroes the device of a process that was killed together with its process group, as
// hydro-launch kills what a program of the user's own leaves.
TEST_F(DeviceRigTest, GuardianSurvivesItsGroup) {
  const pid_t child = fork();
  if (child == 0) {
    setpgid(0, 0);
    auto rig = Open();
    rig->Drive(5);
    shared_->zeros = 0;
    for (;;) pause();
  }
  for (int i = 0; i < 10000 && shared_->output != 10; ++i) usleep(1000);
  ASSERT_EQ(shared_->output, 10);
  kill(-child, SIGKILL);
  waitpid(child, nullptr, 0);
  for (int i = 0; i < 10000 && shared_->zeros == 0; ++i) usleep(1000);
  EXPECT_EQ(shared_->output, 0);
  EXPECT_EQ(shared_->zeros, 1);
}

// Tests that the guardian zeroes the device of a process that was killed and has left a child behind, which
// holds all that the process had open.
TEST_F(DeviceRigTest, GuardianOfAProcessThatForked) {
  const pid_t parent = fork();
  if (parent == 0) {
    auto rig = Open();
    rig->Drive(5);
    shared_->zeros = 0;
    if (fork() != 0) shared_->output = 11;  // from here on, there is a child
    for (;;) pause();
  }
  setpgid(parent, parent);
  for (int i = 0; i < 10000 && shared_->output != 11; ++i) usleep(1000);
  ASSERT_EQ(shared_->output, 11);
  kill(parent, SIGKILL);
  waitpid(parent, nullptr, 0);
  for (int i = 0; i < 10000 && shared_->zeros == 0; ++i) usleep(1000);
  EXPECT_EQ(shared_->output, 0);
  EXPECT_EQ(shared_->zeros, 1);
  kill(-parent, SIGKILL);
}

// Tests that the guardian writes the zero that this process cannot write any more, at once and once.
TEST_F(DeviceRigTest, GuardianWritesWhatTheDriverCannot) {
  auto rig = Open();
  rig->Drive(5);
  shared_->zeros = 0;
  shared_->refuses_zero_of = getpid();
  EXPECT_TRUE(rig->Zero().accepted);
  EXPECT_EQ(shared_->output, 0);
  EXPECT_THROW(rig->Drive(5), RigError) << "nobody would zero it now";
  EXPECT_EQ(shared_->output, 0);
  rig.reset();
  EXPECT_EQ(shared_->zeros, 1);
}

// Tests the same where only the end of the rig writes the zero, and that a guardian which stands still is
// woken for it.
TEST_F(DeviceRigTest, GuardianWritesAtTheEnd) {
  for (const bool stopped : {false, true}) {
    auto rig = Open();
    rig->Drive(5);
    shared_->zeros = 0;
    if (stopped) kill(rig->guardian(), SIGSTOP);
    shared_->refuses_zero_of = getpid();
    rig.reset();
    EXPECT_EQ(shared_->output, 0);
    EXPECT_EQ(shared_->zeros, 1);
    shared_->refuses_zero_of = -1;
  }
}

}  // namespace
}  // namespace hydro::plant
