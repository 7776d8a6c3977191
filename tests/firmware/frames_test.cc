#include "firmware/frames.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "tests/firmware/frame_maker.h"

namespace hydro::firmware {
namespace {

using testing::AnyFrame;
using testing::Bytes;
using testing::kKinds;
using testing::Received;
using testing::Stuffed;
using testing::Wire;

// Tests that the command which docs/front_end.md shows has these bytes.
TEST(FramesTest, TheExampleOfThePage) {
  hydro_frame frame{};
  frame.kind = HYDRO_VOLTAGE;
  frame.session = 0x11223344;
  frame.sequence = 7;
  frame.body.command.fingerprint = 0xDEADBEEF;
  frame.body.command.host_tick = 1000;
  frame.body.command.voltage = 1.5F;
  EXPECT_EQ(Wire(frame), (Bytes{0x00, 0x03, 0x01, 0x04, 0x01, 0x06, 0x44, 0x33, 0x22, 0x11, 0x07, 0x01,
                                0x01, 0x07, 0xef, 0xbe, 0xad, 0xde, 0xe8, 0x03, 0x01, 0x01, 0x01, 0x01,
                                0x01, 0x01, 0x01, 0x07, 0xc0, 0x3f, 0x95, 0x04, 0x90, 0xcd, 0x00}));
}

// Tests that the checksum is that of zlib: its check value, and in parts as in one.
TEST(FramesTest, ChecksumIsZlibs) {
  const uint8_t text[] = {'1', '2', '3', '4', '5', '6', '7', '8', '9'};
  EXPECT_EQ(hydro_crc32(0, text, 9), 0xCBF43926U);
  EXPECT_EQ(hydro_crc32(hydro_crc32(0, text, 4), text + 4, 5), 0xCBF43926U);
  EXPECT_EQ(hydro_crc32(0, text, 0), 0U);
}

// Tests that each kind has the length that the page says: these are on real wires and may not change.
TEST(FramesTest, LengthsAreThoseOfThePage) {
  const std::map<int, size_t> lengths = {
      {HYDRO_HELLO, 16},    {HYDRO_SETTINGS, 208}, {HYDRO_ARM, 24},       {HYDRO_VOLTAGE, 32},
      {HYDRO_PRESSURE, 48}, {HYDRO_ZERO, 16},      {HYDRO_IDENTITY, 76},  {HYDRO_SETTINGS_HELD, 216},
      {HYDRO_SAMPLE, 104},  {HYDRO_OUTPUT, 28},    {HYDRO_CONVERTERS, 72}};
  ASSERT_EQ(lengths.size(), std::size(kKinds));
  for (const uint8_t kind : kKinds) {
    hydro_frame frame{};
    frame.kind = kind;
    EXPECT_EQ(Wire(frame).size(), lengths.at(kind) + 3) << int{kind};
  }
}

// Tests that any contents come back as they were, and that only a frame's ends are zeros.
TEST(FramesTest, ContentsComeBack) {
  std::mt19937 random(1);
  for (int round = 0; round < 2000; ++round) {
    const uint8_t kind = kKinds[round % std::size(kKinds)];
    const Bytes wire = Wire(AnyFrame(kind, random));
    ASSERT_EQ(std::count(wire.begin(), wire.end(), 0), 2);
    hydro_receiver receiver{};
    ASSERT_EQ(Received(wire, &receiver), std::vector<Bytes>{wire});
    ASSERT_EQ(receiver.bad, 0U);
  }
}

// Tests every field of a sample by a value of its own: a codec that exchanged two would not notice itself.
TEST(FramesTest, FieldsOfASample) {
  hydro_frame sent{};
  sent.kind = HYDRO_SAMPLE;
  sent.body.sample = {.tick = 0x0102030405060708,
                      .state = 9,
                      .source = 10,
                      .saturated = 11,
                      .sensor_faults = 12,
                      .faults_present = 0x0D0E,
                      .faults_latched = 0x0F10,
                      .trips = 0x11121314,
                      .command_sequence = 0x15161718,
                      .host_tick = -2,
                      .command_age = 0x191A1B1C,
                      .value = {1, 2, 3, 4, 5, 6},
                      .motor_count = -7,
                      .arm_count = 8,
                      .voltage = 9,
                      .read_back = 10,
                      .pressure_ref = 11,
                      .transfer = 12,
                      .frames_bad = 0x1D1E,
                      .frames_refused = 0x1F20};
  hydro_receiver receiver{};
  hydro_frame found{};
  bool whole = false;
  for (const uint8_t byte : Wire(sent)) whole = hydro_receive(&receiver, byte, &found);
  ASSERT_TRUE(whole);
  const hydro_sample& sample = found.body.sample;
  EXPECT_EQ(sample.tick, 0x0102030405060708U);
  EXPECT_EQ(sample.saturated, 11);
  EXPECT_EQ(sample.faults_latched, 0x0F10);
  EXPECT_EQ(sample.host_tick, -2);
  EXPECT_EQ(sample.command_age, 0x191A1B1CU);
  for (int i = 0; i < HYDRO_SENSORS; ++i) EXPECT_EQ(sample.value[i], static_cast<float>(i + 1));
  EXPECT_EQ(sample.motor_count, -7);
  EXPECT_EQ(sample.transfer, 12);
  EXPECT_EQ(sample.frames_refused, 0x1F20);
}

// Tests that a hello and an identity of a later protocol, which may be longer, are found and say so, and that
// no other frame of another protocol is.
TEST(FramesTest, OtherProtocols) {
  for (const uint8_t kind : kKinds) {
    for (const size_t more : {0, 5}) {
      hydro_frame frame{};
      frame.kind = kind;
      frame.session = 5;
      // Session 5, zeros else.
      Bytes content = {2, kind, 0, 0, 5, 0, 0, 0, 0, 0, 0, 0};
      content.resize(Wire(frame).size() - 3 - 4 + more);
      const Bytes wire = Stuffed(content);
      hydro_receiver receiver{};
      hydro_frame found{};
      bool whole = false;
      for (const uint8_t byte : wire) whole = hydro_receive(&receiver, byte, &found) || whole;
      EXPECT_EQ(whole, kind == HYDRO_HELLO || kind == HYDRO_IDENTITY) << int{kind};
      if (whole) {
        EXPECT_EQ(found.protocol, 2);
      }
      EXPECT_EQ(receiver.bad, whole ? 0U : 1U);
    }
  }
}

// Tests that a kind that does not exist is neither sent nor received.
TEST(FramesTest, NoSuchKind) {
  hydro_frame frame{};
  frame.kind = 0x7F;
  uint8_t wire[HYDRO_WIRE_MAX];
  EXPECT_EQ(hydro_encode(&frame, wire), 0U);
}

// Tests that the fingerprint depends on every byte of the settings and on nothing else.
TEST(FramesTest, FingerprintIsOfEveryByte) {
  hydro_settings settings{};
  const uint32_t plain = hydro_fingerprint(&settings);
  EXPECT_NE(plain, 0U);
  settings.sensors[5].maximum_V = -0.0F;
  EXPECT_NE(hydro_fingerprint(&settings), plain);
  settings = {};
  settings.sensors[0].channel = 1;
  EXPECT_NE(hydro_fingerprint(&settings), plain);
  settings = {};
  settings.mode = 1;
  EXPECT_NE(hydro_fingerprint(&settings), plain);
  settings = {};
  EXPECT_EQ(hydro_fingerprint(&settings), plain);
}

// Tests that "newer" wraps at 2^32 and that nothing is newer than itself.
TEST(FramesTest, NewerWraps) {
  EXPECT_TRUE(hydro_is_newer(1, 0));
  EXPECT_FALSE(hydro_is_newer(0, 0));
  EXPECT_FALSE(hydro_is_newer(0, 1));
  EXPECT_TRUE(hydro_is_newer(3, 0xFFFFFFFE));
  EXPECT_FALSE(hydro_is_newer(0xFFFFFFFE, 3));
  EXPECT_TRUE(hydro_is_newer(0x7FFFFFFF, 0));
  EXPECT_FALSE(hydro_is_newer(0x80000000, 0));
}

}  // namespace
}  // namespace hydro::firmware
