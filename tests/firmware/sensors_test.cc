#include "firmware/sensors.h"

#include <gtest/gtest.h>

#include "tests/firmware/device_bench.h"

namespace hydro::firmware {
namespace {

using testing::Analog;
using testing::BenchFacts;
using testing::BenchSettings;
using testing::Counter;
using testing::kInfinity;

class SensorsTest : public ::testing::Test {
 protected:
  SensorsTest() {
    readings_.elapsed_ticks = 1;
    readings_.answered = true;
    hydro_sensors_begin(&sensors_);
  }
  void Read() { hydro_sensors_read(&sensors_, &settings_, &facts_, &readings_); }
  float Value(int index) const { return sensors_.sensor[index].value; }

  const hydro_board_facts facts_ = BenchFacts();
  hydro_settings settings_ = BenchSettings();
  hydro_readings readings_{};
  hydro_sensors sensors_{};
};

// Tests that nothing is known before the first reading.
TEST_F(SensorsTest, NothingAtFirst) {
  for (int i = 0; i < HYDRO_SENSORS; ++i) EXPECT_TRUE(std::isnan(Value(i)));
  EXPECT_EQ(hydro_sensors_faults(&sensors_), 0);
}

// Tests scale and offset, and that what is not configured stays unknown.
TEST_F(SensorsTest, ScaleAndOffset) {
  settings_.sensors[HYDRO_P1] = Analog(3, -250, 100);
  settings_.sensors[HYDRO_P2] = {};
  readings_.analog_V[3] = 2;
  Read();
  EXPECT_FLOAT_EQ(Value(HYDRO_P1), -400);
  EXPECT_TRUE(std::isnan(Value(HYDRO_P2)));
  EXPECT_EQ(hydro_sensors_faults(&sensors_), 0);
}

// Tests that a counter is followed over its wrap both ways, whatever its bits, and begins below zero just
// below the wrap.
TEST_F(SensorsTest, CounterWraps) {
  for (const uint8_t bits : {8, 16, 24, 31, 32}) {
    hydro_sensors_begin(&sensors_);
    settings_.sensors[HYDRO_MOTOR_ANGLE] = Counter(1, bits, 0.5F);
    const uint32_t mask = static_cast<uint32_t>((uint64_t{1} << bits) - 1);
    const auto read = [&](uint32_t count) {
      readings_.counter[1] = count & mask;
      Read();
      return sensors_.sensor[HYDRO_MOTOR_ANGLE].count;
    };
    EXPECT_EQ(read(mask - 2), -3) << int{bits};
    EXPECT_FLOAT_EQ(Value(HYDRO_MOTOR_ANGLE), -1.5);
    EXPECT_EQ(read(2), 2);
    EXPECT_EQ(read(mask), -1);
    int64_t truth = -1;
    for (int step = 0; step < 1000; ++step) read(static_cast<uint32_t>(truth += 31));
    EXPECT_EQ(sensors_.sensor[HYDRO_MOTOR_ANGLE].count, truth) << int{bits};
    EXPECT_EQ(hydro_sensors_faults(&sensors_), 0) << int{bits};
  }
}

// Tests that bits above the counter's are of no account, and that 2^31 counts wrap as the page says.
TEST_F(SensorsTest, CountWrapsAtThe32ndBit) {
  settings_.sensors[HYDRO_MOTOR_ANGLE] = Counter(0, 16, 1);
  uint32_t reading = 0xABCD0000;
  for (int64_t moved = 0; moved <= 0x80000000; moved += 16000, reading += 16000) {
    readings_.counter[0] = reading;
    Read();
  }
  EXPECT_EQ(hydro_sensors_faults(&sensors_), 0);
  const int64_t last = 0x80000000 / 16000 * 16000;
  readings_.counter[0] = static_cast<uint32_t>(last + 0x1000);
  Read();
  EXPECT_EQ(sensors_.sensor[HYDRO_MOTOR_ANGLE].count,
            static_cast<int32_t>(static_cast<uint32_t>(last + 0x1000)));
}

// Tests that a counter that moves by a quarter of its range is lost, and stays so although it counts on.
TEST_F(SensorsTest, CounterIsLost) {
  settings_.sensors[HYDRO_MOTOR_ANGLE] = Counter(0, 16, 1);
  Read();
  readings_.counter[0] = 16383;
  Read();
  EXPECT_EQ(hydro_sensors_faults(&sensors_), 0);
  readings_.counter[0] = 16383 + 16384;
  for (int tick = 0; tick < 50; ++tick) Read();
  EXPECT_EQ(hydro_sensors_faults(&sensors_), 1 << HYDRO_MOTOR_ANGLE);
  EXPECT_TRUE(std::isnan(Value(HYDRO_MOTOR_ANGLE)));
  EXPECT_TRUE(std::isnan(Value(HYDRO_MOTOR_SPEED)));
}

// Tests that a speed is the rate of its angle over the ticks that passed: one, several, and those without an
// answer.
TEST_F(SensorsTest, RatesOverTicks) {
  const auto speed = [&](uint32_t count, uint32_t elapsed) {
    readings_.counter[0] = count;
    readings_.elapsed_ticks = elapsed;
    Read();
    return Value(HYDRO_MOTOR_SPEED);
  };
  EXPECT_EQ(speed(5, 1), 0);
  EXPECT_FLOAT_EQ(speed(8, 1), 30);  // 3 counts of 0.01 rad in 1 ms
  EXPECT_FLOAT_EQ(speed(18, 5), 20);
  hydro_sensors_unknown(&sensors_, 3);
  EXPECT_TRUE(std::isnan(Value(HYDRO_MOTOR_SPEED)));
  EXPECT_FLOAT_EQ(speed(58, 1), 100);  // 40 counts in 4 ticks
  EXPECT_FLOAT_EQ(speed(58, 1), 0);
}

// Tests the low pass: its first value is the reading, then each tick takes over its share; after a gap it
// begins anew.
TEST_F(SensorsTest, LowPass) {
  settings_.sensors[HYDRO_P1].low_pass_share = 0.25F;
  const auto read = [&](float volts) {
    readings_.analog_V[0] = volts;
    Read();
    return Value(HYDRO_P1);
  };
  EXPECT_FLOAT_EQ(read(4), 400);
  EXPECT_FLOAT_EQ(read(8), 500);
  EXPECT_FLOAT_EQ(read(8), 575);
  EXPECT_TRUE(std::isnan(read(10)));
  EXPECT_FLOAT_EQ(read(1), 100);
  hydro_sensors_unknown(&sensors_, 1);
  EXPECT_FLOAT_EQ(read(2), 200);
}

// Tests which readings are credible: within the ends of the range, or the limits that are given instead; and
// numbers.
TEST_F(SensorsTest, CredibleReadings) {
  const auto credible = [&](float volts, float low, float high) {
    hydro_sensors_begin(&sensors_);
    settings_.sensors[HYDRO_P1].minimum_V = low;
    settings_.sensors[HYDRO_P1].maximum_V = high;
    readings_.analog_V[0] = volts;
    Read();
    EXPECT_EQ(std::isnan(Value(HYDRO_P1)), hydro_sensors_faults(&sensors_) == 1);
    return hydro_sensors_faults(&sensors_) == 0;
  };
  EXPECT_TRUE(credible(9.99F, -kInfinity, kInfinity));
  EXPECT_FALSE(credible(10, -kInfinity, kInfinity));
  EXPECT_FALSE(credible(-10, -kInfinity, kInfinity));
  EXPECT_TRUE(credible(0.5F, 0.5F, 4.5F));
  EXPECT_FALSE(credible(0.49F, 0.5F, 4.5F));
  EXPECT_FALSE(credible(4.51F, 0.5F, 4.5F));
  EXPECT_TRUE(credible(-9, -kInfinity, 4.5F));
  EXPECT_FALSE(credible(NAN, 0.5F, 4.5F));
  EXPECT_FALSE(credible(kInfinity, -kInfinity, kInfinity));
}

// Tests that a fault lasts until the tenth good reading in a row.
TEST_F(SensorsTest, TenGoodReadings) {
  readings_.analog_V[0] = 10;
  Read();
  readings_.analog_V[0] = 1;
  for (int good = 1; good <= 9; ++good) Read();
  EXPECT_EQ(hydro_sensors_faults(&sensors_), 1);
  readings_.analog_V[0] = 10;
  Read();
  readings_.analog_V[0] = 1;
  for (int good = 1; good <= 9; ++good) Read();
  EXPECT_EQ(hydro_sensors_faults(&sensors_), 1);
  Read();
  EXPECT_EQ(hydro_sensors_faults(&sensors_), 0);
}

}  // namespace
}  // namespace hydro::firmware
