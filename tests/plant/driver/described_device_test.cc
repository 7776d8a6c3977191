#include "plant/driver/described_device.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "base/input_error.h"

namespace hydro::plant {
namespace {

using namespace std::string_literals;
using ::testing::AllOf;
using ::testing::HasSubstr;

// A device of which the test says what it describes and reads.
class ToldDevice : public Device {
 public:
  DeviceDescription Describe() const override { return description; }
  void Read(DeviceReadings& into) override { into = readings; }
  void Drive(double) override {}
  bool Zero(double) noexcept override { return true; }

  DeviceDescription description{.name = "box", .inputs = {{.name = "ai0"}}};
  DeviceReadings readings{.inputs = {{.value = 1}}, .output = {}, .fault = {}};
};

std::string Refusal(const ToldDevice& device) {
  try {
    Described(device, "stack.toml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

// Tests that no text of a driver moves a terminal's cursor or carries a NUL, which no message can; and that a
// device without a name has one.
TEST(DescribedDeviceTest, TextsAreFitToBeShown) {
  ToldDevice device;
  device.description.name = "a\nb\x1b[2J";
  device.description.output.unit = "mA\0\0"s;
  device.description.inputs = {{.name = "ai\0xyz"s, .unit = "\x07V", .place = "slot\r3"}};
  DeviceDescription shown = Described(device, "stack.toml");
  EXPECT_EQ(shown.name, "a\\x0ab\\x1b[2J");
  EXPECT_EQ(shown.output.unit, "mA");
  EXPECT_EQ(shown.inputs[0].name, "ai");
  EXPECT_EQ(shown.inputs[0].unit, "\\x07V");
  EXPECT_EQ(shown.inputs[0].place, "slot\\x0d3");
  device.description.name = "\0box"s;
  EXPECT_EQ(Described(device, "stack.toml").name, "the device");

  device.readings.fault = "E12\0\x1b\0"s;
  DeviceReadings readings;
  ReadDevice(device, shown, readings);
  EXPECT_EQ(readings.fault, "E12");
  device.readings.fault = "\x1b[2J\nx";
  ReadDevice(device, shown, readings);
  EXPECT_EQ(readings.fault, "\\x1b[2J\\x0ax");
  EXPECT_STREQ(DeviceError("").what(), "the device's driver gives no reason");
  EXPECT_STREQ(DeviceError("it is off").what(), "it is off");
}

// Tests that what no device can have is refused, in words that name what is allowed.
TEST(DescribedDeviceTest, WhatCannotBe) {
  ToldDevice device;
  EXPECT_EQ(Refusal(device), "");
  for (const double tolerance : {std::nan(""), -1.0}) {
    device.description.output.tolerance = tolerance;
    EXPECT_THAT(Refusal(device),
                AllOf(HasSubstr("stack.toml: driver.device: found an output with a tolerance"),
                      HasSubstr("allowed a number of at least 0")));
  }
  device.description.output.tolerance = 0;
  for (const uint32_t highest : {0U, 6U}) {
    device.description.inputs = {
        {.name = "encoder", .kind = DeviceInput::Kind::kCount, .highest_count = highest}};
    EXPECT_THAT(Refusal(device),
                HasSubstr("found a counter \"encoder\" that wraps after " + std::to_string(highest) +
                          ", as its driver describes it, allowed one that counts to 7"));
  }
  device.description.inputs[0].highest_count = 7;
  EXPECT_EQ(Refusal(device), "");
  device.description.inputs = {{.name = "ai0", .low = 10, .high = NAN}};
  EXPECT_THAT(Refusal(device), HasSubstr("found an input \"ai0\" from 10 to nan V"));
}

// Tests that a time from before the clock's begin is none that a difference could overflow with.
TEST(DescribedDeviceTest, TimesBeforeTheBegin) {
  ToldDevice device;
  device.readings.inputs[0].at = device.readings.output.at = bus::Clock::TimePoint::min();
  DeviceReadings readings;
  ReadDevice(device, device.description, readings);
  EXPECT_EQ(readings.inputs[0].at, bus::Clock::TimePoint{});
  EXPECT_EQ(readings.output.at, bus::Clock::TimePoint{});
}

}  // namespace
}  // namespace hydro::plant
