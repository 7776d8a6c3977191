#include "firmware/boards/converter_link.h"

#include <gtest/gtest.h>

#include "tests/firmware/frame_maker.h"

namespace hydro::firmware {
namespace {

class ConverterLinkTest : public ::testing::Test {
 protected:
  ConverterLinkTest() {
    hydro_converter_link_begin(&link_, 5);
    readings_.elapsed_ticks = 1;
  }
  // The simulator's values that follow the output of this tick.
  void Give(uint64_t tick, float read_back = 0, uint8_t kind = HYDRO_CONVERTERS) {
    hydro_frame frame{};
    frame.kind = kind;
    frame.body.converters.tick = tick;
    frame.body.converters.analog_V[7] = 3;
    frame.body.converters.counter[1] = 0xFFFFFFFE;
    frame.body.converters.read_back_V = read_back;
    frame.body.converters.interlock = 1;
    for (const uint8_t byte : testing::Wire(frame)) hydro_converter_link_take(&link_, byte);
  }
  void Read() { hydro_converter_link_read(&link_, &readings_); }

  hydro_converter_link link_{};
  hydro_readings readings_{};
};

// Tests that there are no values before the first, that they are as sent, and that they hold until they are
// stale.
TEST_F(ConverterLinkTest, ValuesHoldUntilTheyAreStale) {
  Read();
  EXPECT_FALSE(readings_.answered);
  Give(0);
  for (int age = 0; age < 5; ++age) {
    Read();
    EXPECT_TRUE(readings_.answered) << age;
  }
  EXPECT_EQ(readings_.analog_V[7], 3);
  EXPECT_EQ(readings_.counter[1], 0xFFFFFFFE);
  EXPECT_TRUE(readings_.interlock_closed);
  Read();
  EXPECT_FALSE(readings_.answered);
  Give(1);
  readings_.elapsed_ticks = 100;  // missed ticks make values that have just come no older
  Read();
  EXPECT_TRUE(readings_.answered);
}

// Tests that another frame on the link is no values.
TEST_F(ConverterLinkTest, OtherFrames) {
  Give(0, 0, HYDRO_SAMPLE);
  Read();
  EXPECT_FALSE(readings_.answered);
}

// Tests that outputs are counted, and that a read-back counts only behind the newest of them.
TEST_F(ConverterLinkTest, ReadBackOfTheNewestOutput) {
  uint8_t wire[HYDRO_WIRE_MAX];
  Give(0, 1);
  Read();
  EXPECT_TRUE(readings_.read_back_V != readings_.read_back_V) << "nothing was written yet";
  for (uint64_t tick = 0; tick < 3; ++tick) {
    hydro_receiver receiver{};
    hydro_frame frame{};
    const size_t count = hydro_converter_link_output(&link_, 2.5F, wire);
    bool whole = false;
    for (size_t i = 0; i < count; ++i) whole = hydro_receive(&receiver, wire[i], &frame);
    ASSERT_TRUE(whole);
    EXPECT_EQ(frame.body.output.tick, tick);
    EXPECT_EQ(frame.body.output.volts, 2.5F);
  }
  Give(1, 1);
  Read();
  EXPECT_TRUE(readings_.read_back_V != readings_.read_back_V) << "it is of an older output";
  Give(2, 2.5F);
  Read();
  EXPECT_EQ(readings_.read_back_V, 2.5F);
}

}  // namespace
}  // namespace hydro::firmware
