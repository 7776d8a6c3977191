#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <filesystem>

#include "base/input_error.h"
#include "plant/driver/check_sensors.h"
#include "plant/driver/comedi_device.h"
#include "plant/driver/device_rig.h"
#include "tests/plant/driver/simulated_board.h"
#include "tests/stack_fixture.h"

namespace hydro::plant {
namespace {

using ::testing::HasSubstr;
using testing::SimulatedBoard;
using Source = settings::SensorSection::Source;

// The rig behind a board whose registers the test sets, with a clock that the test moves.
class ComediRigTest : public ::testing::Test {
 protected:
  ComediRigTest() : file_("/tmp/hydro_comedi_rig_test_" + std::to_string(getpid())) {
    board_ = testing::CreateBoard(file_.c_str());
    config_ = testing::SmallStack();
    config_.file = "rig.toml";
    settings::DriverSection driver;
    driver.device = file_;
    driver.voltage.line = {1, 0};
    driver.voltage.scale = -2;
    driver.watchdog = settings::BoardLine{2, 3};
    driver.p1 = Analog(0, 500, -250);
    driver.p2 = Analog(1, 500, -250);
    driver.motor_speed = Analog(2, -100, 0);
    config_.driver = driver;
  }
  ~ComediRigTest() override { std::filesystem::remove(file_); }

  static settings::SensorSection Analog(int channel, double scale, double offset) {
    settings::SensorSection section;
    section.source = Source::kAnalog;
    section.line = {0, channel};
    section.scale = scale;
    section.offset = offset;
    return section;
  }

  void UseEncoder(double low_pass_hz = 0) {
    config_.driver->motor_angle.source = Source::kCounter;
    config_.driver->motor_angle.line = {3, 1};
    config_.driver->motor_angle.scale = -0.01;
    config_.driver->motor_speed = {};
    config_.driver->motor_speed.source = Source::kDerivative;
    config_.driver->motor_speed.low_pass_hz = low_pass_hz;
  }

  std::unique_ptr<DeviceRig> Open() {
    return std::make_unique<DeviceRig>(config_, clock_,
                                       std::make_unique<ComediDevice>(config_, clock_, true));
  }

  std::string OpenError() {
    try {
      Open();
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }

  void SetVolts(int input, double volts) { board_->inputs[input] = std::lround((volts + 10) / 20 * 0xffff); }
  double Terminal() const { return 20.0 * static_cast<double>(board_->outputs[0]) / 0xffff - 10; }

  model::Measurement Read(DeviceRig& rig) {
    clock_.AdvanceTo(clock_.Now() + std::chrono::milliseconds(1));
    return rig.Read(tick_++);
  }

  std::string file_;
  SimulatedBoard* board_;
  settings::StackConfig config_;
  bus::SimulatedClock clock_;
  int64_t tick_ = 0;
};

// Tests that opening the board sets the output to zero, whatever it was, and that closing it does so again.
TEST_F(ComediRigTest, ZeroWhenOpenedAndWhenClosed) {
  ASSERT_NE(board_->outputs[0], SimulatedBoard::kZeroCode);
  auto rig = Open();
  EXPECT_EQ(board_->outputs[0], SimulatedBoard::kZeroCode);
  EXPECT_EQ(board_->edges, 0) << "the watchdog is for ticks only";
  EXPECT_EQ(rig->Drive(4), 4);
  EXPECT_NE(board_->outputs[0], SimulatedBoard::kZeroCode);
  rig.reset();
  EXPECT_EQ(board_->outputs[0], SimulatedBoard::kZeroCode);
  EXPECT_EQ(board_->lines, 0);
  EXPECT_EQ(board_->opened, 1);
  EXPECT_EQ(board_->closed, 1);
}

// Tests that Zero() works at any time and twice.
TEST_F(ComediRigTest, Zero) {
  const auto rig = Open();
  rig->Drive(-3);
  rig->Zero();
  const OutputLeft left = rig->Zero();
  EXPECT_EQ(board_->outputs[0], SimulatedBoard::kZeroCode);
  EXPECT_TRUE(left.accepted);
  EXPECT_NEAR(left.voltage, 0, 4e-4);
  rig->Drive(-3);
  board_->order = SimulatedBoard::kWritesFail;
  const OutputLeft stuck = rig->Zero();
  EXPECT_FALSE(stuck.accepted);
  EXPECT_NEAR(stuck.voltage, -3, 1e-3);
  board_->order = SimulatedBoard::kReadsFail;
  EXPECT_TRUE(std::isnan(rig->Zero().voltage));
}

// Tests scale, sign and offset of the amplifier, and that an offset also moves the zero.
TEST_F(ComediRigTest, AmplifierScale) {
  config_.driver->voltage.offset = 0.5;  // V at the motor with 0 V at the terminal
  const auto rig = Open();
  EXPECT_NEAR(Terminal(), 0.25, 2e-4);
  EXPECT_EQ(rig->Drive(4), 4);
  EXPECT_NEAR(Terminal(), -1.75, 2e-4);
  EXPECT_EQ(rig->Drive(-4), -4);
  EXPECT_NEAR(Terminal(), 2.25, 2e-4);
  rig->Drive(0);
  EXPECT_NEAR(Terminal(), 0.25, 2e-4);
}

// Tests that the limit, or else the output's range, cuts the voltage and that the rig reports it; that a
// voltage that is not finite becomes zero.
TEST_F(ComediRigTest, Limits) {
  config_.driver->voltage.limit_V = 1.5;
  {
    const auto rig = Open();
    EXPECT_EQ(rig->Drive(9), 1.5);
    EXPECT_NEAR(Terminal(), -0.75, 2e-4);
    EXPECT_EQ(rig->Drive(-9), -1.5);
    EXPECT_EQ(rig->Drive(NAN), 0);
    EXPECT_EQ(board_->outputs[0], SimulatedBoard::kZeroCode);
  }
  config_.driver->voltage.limit_V = INFINITY;
  config_.driver->voltage.range = 1;  // +/- 5 V, which the amplifier doubles
  const auto rig = Open();
  EXPECT_EQ(rig->Drive(30), 10);
  EXPECT_EQ(board_->outputs[0], 0);
}

// Tests that the watchdog line changes once with each voltage, and not when the board refuses the voltage.
TEST_F(ComediRigTest, Watchdog) {
  const auto rig = Open();
  EXPECT_EQ(board_->directions, 1 << 3);
  const int64_t idle = board_->line_writes;  // low, with the first zero
  for (int i = 1; i <= 5; ++i) {
    rig->Drive(0);
    EXPECT_EQ(board_->lines, i % 2 == 1 ? 1 << 3 : 0);
    EXPECT_EQ(board_->line_writes, idle + i);
  }
  board_->order = SimulatedBoard::kNextWriteFails;
  EXPECT_THROW(rig->Drive(1), RigError);
  EXPECT_EQ(board_->line_writes, idle + 5);
}

// Tests scales, signs and offsets of analog inputs, and that unwired inputs are not measured.
TEST_F(ComediRigTest, AnalogInputs) {
  const auto rig = Open();
  SetVolts(0, 1.5);
  SetVolts(1, 4);
  SetVolts(2, 2);
  const model::Measurement measured = Read(*rig);
  EXPECT_NEAR(measured.p1, 500, 0.1);
  EXPECT_NEAR(measured.p2, 1750, 0.1);
  EXPECT_NEAR(measured.motor_speed, -200, 0.02);
  for (const double signal : {measured.motor_angle, measured.arm_angle, measured.arm_speed}) {
    EXPECT_TRUE(std::isnan(signal));
  }
  EXPECT_TRUE(rig->faults().empty()) << "what is not wired is no fault";
}

// Tests the low pass of a channel: after 1/(2 pi f) a step has reached 63 %.
TEST_F(ComediRigTest, LowPassOfAChannel) {
  config_.driver->p1.low_pass_hz = 1000 / (2 * M_PI) / 10;  // 10 ticks
  const auto rig = Open();
  SetVolts(0, 1);
  EXPECT_NEAR(Read(*rig).p1, 250, 0.1);
  SetVolts(0, 3);
  for (int i = 0; i < 9; ++i) Read(*rig);
  EXPECT_NEAR(Read(*rig).p1, 250 + 1000 * (1 - std::exp(-1)), 0.2);
}

// Tests that both ends of the range are no readings and give a fault of that sensor's name, that the other
// sensors are not affected, and that the fault ends only after ten good readings in a row.
TEST_F(ComediRigTest, SaturatedInput) {
  const auto rig = Open();
  SetVolts(0, 1);
  for (const int64_t end : {int64_t{0}, SimulatedBoard::kMaxCode}) {
    board_->inputs[1] = end;
    const model::Measurement measured = Read(*rig);
    EXPECT_TRUE(std::isnan(measured.p2));
    EXPECT_FALSE(std::isnan(measured.p1));
    ASSERT_EQ(rig->faults().size(), 1u);
    EXPECT_EQ(rig->faults()[0].code, "sensor_p2");
    EXPECT_THAT(rig->faults()[0].text, HasSubstr(end == 0 ? "p2 reads -10 V" : "p2 reads 10 V"));
    SetVolts(1, 1);
    for (int i = 0; i < 5; ++i) Read(*rig);
    board_->inputs[1] = end;  // a loose contact
    Read(*rig);
    SetVolts(1, 1);
    for (int i = 0; i < 9; ++i) {
      EXPECT_FALSE(std::isnan(Read(*rig).p2));
      EXPECT_EQ(rig->faults().size(), 1u) << i;
    }
    Read(*rig);
    EXPECT_TRUE(rig->faults().empty());
  }
}

// Tests that a sensor's own limits find a broken wire, and that an end of the range within them is a reading.
TEST_F(ComediRigTest, PlausibleVolts) {
  config_.driver->p1.minimum = 0.4;
  config_.driver->p1.maximum = 20;
  config_.driver->p1.limit_suffix = "_V";
  const auto rig = Open();
  SetVolts(1, 1);
  SetVolts(0, 0.3);
  EXPECT_TRUE(std::isnan(Read(*rig).p1));
  ASSERT_EQ(rig->faults().size(), 1u);
  EXPECT_THAT(rig->faults()[0].text, HasSubstr("driver.p1.minimum_V"));
  EXPECT_EQ(rig->faults()[0].limit, 0.4);
  SetVolts(0, 10);
  EXPECT_NEAR(Read(*rig).p1, 4750, 0.1);
}

// Tests the encoder: sign, wrap, and the speed from its counts over the time that has passed, also where a
// wake-up was late.
TEST_F(ComediRigTest, EncoderAndSpeed) {
  UseEncoder();
  board_->counters[1] = SimulatedBoard::kMaxCount - 4;
  const auto rig = Open();
  model::Measurement measured = Read(*rig);
  EXPECT_DOUBLE_EQ(measured.motor_angle, 0.05);
  EXPECT_EQ(measured.motor_speed, 0);
  board_->counters[1] = 5;  // ten counts on, through the wrap
  measured = Read(*rig);
  EXPECT_DOUBLE_EQ(measured.motor_angle, -0.05);
  EXPECT_NEAR(measured.motor_speed, -100, 1e-9);
  clock_.AdvanceTo(clock_.Now() + std::chrono::milliseconds(9));
  board_->counters[1] = 105;
  EXPECT_NEAR(Read(*rig).motor_speed, -100, 1e-9);
}

// Tests that a rate is filtered and its angle is not.
TEST_F(ComediRigTest, FilteredSpeed) {
  UseEncoder(1000 / (2 * M_PI));
  const auto rig = Open();
  Read(*rig);
  board_->counters[1] = 10;
  const model::Measurement measured = Read(*rig);
  EXPECT_DOUBLE_EQ(measured.motor_angle, -0.1);
  EXPECT_NEAR(measured.motor_speed, -100 * (1 - std::exp(-1)), 1e-9);
}

// Tests that a counter that has jumped ends the run: its angle is lost.
TEST_F(ComediRigTest, EncoderLost) {
  UseEncoder();
  const auto rig = Open();
  Read(*rig);
  board_->counters[1] = 0x400000;
  try {
    Read(*rig);
    FAIL();
  } catch (const RigError& error) {
    EXPECT_EQ(error.code(), "encoder_lost");
  }
}

// Tests that an error of the board names key, channel and cause, and that an interrupted call is no error.
TEST_F(ComediRigTest, BoardErrors) {
  const auto rig = Open();
  board_->order = SimulatedBoard::kInterrupt;
  for (int i = 0; i < 10; ++i) EXPECT_NO_THROW(Read(*rig));
  board_->order = SimulatedBoard::kReadsFail;
  try {
    Read(*rig);
    FAIL();
  } catch (const RigError& error) {
    EXPECT_EQ(error.code(), "board_error");
    EXPECT_THAT(error.what(), HasSubstr("driver.p1: reading subdevice 0, channel 0"));
    EXPECT_THAT(error.what(), HasSubstr("Input/output error"));
  }
}

// Tests that the pause for the multiplexer is requested where it is set, for analog inputs only.
TEST_F(ComediRigTest, Settling) {
  UseEncoder();
  config_.driver->settle_ns = 5000;
  const auto rig = Open();
  Read(*rig);
  EXPECT_EQ(board_->delayed_reads, 2);
  EXPECT_EQ(board_->reads, 3);
}

// Tests that a feature that the board lacks is bad input that names the key, and leaves no trace on the
// board.
TEST_F(ComediRigTest, WhatTheBoardLacks) {
  config_.driver->p2.line.channel = 8;
  EXPECT_THAT(OpenError(), HasSubstr("rig.toml: driver.p2.channel: found 8, allowed 0 to 7"));
  config_.driver->p2.line = {4, 0};
  EXPECT_THAT(OpenError(), HasSubstr("driver.p2.subdevice: found 4, allowed a subdevice of"));
  config_.driver->device = "/nonexistent";
  EXPECT_THAT(OpenError(), HasSubstr("driver.device: found \"/nonexistent\" (No such file or directory)"));
  EXPECT_EQ(board_->writes, 0);
  EXPECT_EQ(board_->opened, board_->closed);
}

// Tests that a board that takes no zero is never driven.
TEST_F(ComediRigTest, RefusedZero) {
  board_->order = SimulatedBoard::kWritesFail;
  EXPECT_THROW(Open(), RigError);
}

// Tests that the guardian writes the zero when the process ends without a word, and does nothing once
// dismissed.
TEST_F(ComediRigTest, Guardian) {
  for (const bool dismissed : {false, true}) {
    const pid_t child = fork();
    if (child == 0) {
      auto rig = Open();
      rig->Drive(5);
      if (dismissed) {
        rig.reset();
        board_->outputs[0] = 7;  // somebody else's business from now on
      }
      _exit(0);
    }
    int status = 0;
    waitpid(child, &status, 0);
    ASSERT_EQ(status, 0);
    const int64_t expected = dismissed ? 7 : SimulatedBoard::kZeroCode;
    for (int i = 0; i < 10000 && board_->outputs[0] != expected; ++i) usleep(1000);
    EXPECT_EQ(board_->outputs[0], expected);
    EXPECT_EQ(board_->nonzero_writes, dismissed ? 2 : 1);
  }
}

// Tests that no voltage is put out once the guardian has been killed, or stands still: a kill of the driver
// would leave it.
TEST_F(ComediRigTest, WithoutAGuardianNoVoltage) {
  for (const int signal : {SIGKILL, SIGSTOP}) {
    board_->nonzero_writes = 0;
    auto rig = Open();
    rig->Drive(5);
    kill(rig->guardian(), signal);
    std::string code;
    for (int i = 0; i < 10000 && code.empty(); ++i) {
      const int64_t writes = board_->nonzero_writes;
      try {
        rig->Drive(5);
        usleep(1000);
      } catch (const RigError& error) {
        code = error.code();
        EXPECT_THAT(error.what(), HasSubstr("hydro-zero"));
        EXPECT_EQ(board_->nonzero_writes, writes) << "before the voltage, not after";
      }
    }
    EXPECT_EQ(code, "guardian_gone") << signal;
    EXPECT_TRUE(rig->Zero().accepted);
    EXPECT_EQ(board_->outputs[0], SimulatedBoard::kZeroCode);
    EXPECT_THROW(rig->Drive(5), RigError) << "it does not come back";
    rig.reset();
    EXPECT_EQ(board_->outputs[0], SimulatedBoard::kZeroCode);
  }
}

// Tests that a stopped guardian does not keep us from ending.
TEST_F(ComediRigTest, StoppedGuardian) {
  ComediDevice board(config_, clock_, true);
  ZeroGuardian guardian(board, board.Describe().files, 0);
  kill(guardian.pid(), SIGSTOP);
  guardian.Dismiss();
  EXPECT_EQ(kill(guardian.pid(), 0), -1) << "it has gone";
}

// Tests that a guardian whose end somebody else has waited for is forgotten: its number may be another's.
TEST_F(ComediRigTest, GuardianThatIsWaitedForElsewhere) {
  ComediDevice board(config_, clock_, true);
  ZeroGuardian guardian(board, board.Describe().files, 0);
  kill(guardian.pid(), SIGKILL);
  waitpid(guardian.pid(), nullptr, 0);
  guardian.Dismiss();
  EXPECT_EQ(guardian.pid(), -1);
  EXPECT_FALSE(guardian.WriteZero());
}

// Tests the lines of --check-sensors, and that it leaves the board alone.
TEST_F(ComediRigTest, CheckSensorsLines) {
  UseEncoder();
  ComediDevice board(config_, clock_, false);
  DeviceSensors sensors(board.Describe(), config_);
  SetVolts(0, 2);
  board_->inputs[1] = SimulatedBoard::kMaxCode;
  board_->counters[1] = 100;
  DeviceReadings readings;
  readings.inputs.resize(board.Describe().inputs.size());
  board.Read(readings);
  const model::Measurement measured = sensors.Take(readings, clock_.Now());
  const auto all = sensors.all();
  EXPECT_THAT(DescribeReading(*all[0], measured.p1, {}),
              ::testing::ContainsRegex("p1 +analog 0/0 .* 2.000. V +750.* psi$"));
  EXPECT_THAT(DescribeReading(*all[0], measured.p1, kSiUnits), HasSubstr(" Pa"));
  EXPECT_THAT(DescribeReading(*all[1], measured.p2, {}), HasSubstr("FAULT: p2 reads 10 V"));
  EXPECT_THAT(DescribeReading(*all[2], measured.motor_angle, {}),
              ::testing::ContainsRegex("motor_angle +counter 3/1 +100 +-1 rad$"));
  EXPECT_THAT(DescribeReading(*all[4], measured.arm_angle, {}), HasSubstr("not measured"));
  EXPECT_EQ(board_->writes + board_->line_writes + board_->directions, 0);
}

}  // namespace
}  // namespace hydro::plant
