// What damage on the wire does: nothing damaged is taken for a frame, and the next frame that arrives whole
// is found.
#include <gtest/gtest.h>

#include "tests/firmware/frame_maker.h"

namespace hydro::firmware {
namespace {

using testing::AnyFrame;
using testing::Append;
using testing::Bytes;
using testing::kKinds;
using testing::Received;
using testing::Wire;

class FramesDamageTest : public ::testing::Test {
 protected:
  // What was sent and damaged, followed by a frame that was not: only the latter may be found, and must be.
  void ExpectOnlyNext(Bytes damaged) {
    Append(&damaged, next_);
    const std::vector<Bytes> found = Received(damaged);
    ASSERT_EQ(found, std::vector<Bytes>{next_});
  }

  std::mt19937 random_{7};
  const Bytes next_ = Wire(AnyFrame(HYDRO_PRESSURE, random_));
};

// Tests every single wrong bit of a frame of each kind, in its delimiters too.
TEST_F(FramesDamageTest, EachBit) {
  for (const uint8_t kind : kKinds) {
    const Bytes wire = Wire(AnyFrame(kind, random_));
    for (size_t bit = 0; bit < 8 * wire.size(); ++bit) {
      Bytes damaged = wire;
      damaged[bit / 8] ^= static_cast<uint8_t>(1U << (bit % 8));
      ASSERT_NO_FATAL_FAILURE(ExpectOnlyNext(damaged)) << "kind " << int{kind} << " bit " << bit;
    }
  }
}

// Tests every pair of wrong bits of a command.
TEST_F(FramesDamageTest, EachPairOfBits) {
  const Bytes wire = Wire(AnyFrame(HYDRO_VOLTAGE, random_));
  for (size_t a = 0; a < 8 * wire.size(); ++a) {
    for (size_t b = a + 1; b < 8 * wire.size(); ++b) {
      Bytes damaged = wire;
      damaged[a / 8] ^= static_cast<uint8_t>(1U << (a % 8));
      damaged[b / 8] ^= static_cast<uint8_t>(1U << (b % 8));
      ASSERT_NO_FATAL_FAILURE(ExpectOnlyNext(damaged)) << "bits " << a << " and " << b;
    }
  }
}

// Tests a frame that ends early or begins late, wherever that is.
TEST_F(FramesDamageTest, Truncated) {
  for (const uint8_t kind : kKinds) {
    const Bytes wire = Wire(AnyFrame(kind, random_));
    for (size_t length = 1; length + 1 < wire.size(); ++length) {
      ASSERT_NO_FATAL_FAILURE(ExpectOnlyNext(Bytes(wire.begin(), wire.begin() + length)));
      ASSERT_NO_FATAL_FAILURE(ExpectOnlyNext(Bytes(wire.end() - length, wire.end())));
    }
  }
}

// Tests a byte that is lost, one that comes twice, two that change places, and a foreign one, at each
// position. A neighbour of the same value makes no damage, nor do delimiters that come twice.
TEST_F(FramesDamageTest, BytesLostDoubledExchangedAdded) {
  for (const uint8_t kind : kKinds) {
    const Bytes wire = Wire(AnyFrame(kind, random_));
    for (size_t at = 1; at + 1 < wire.size(); ++at) {
      Bytes lost = wire, doubled = wire, exchanged = wire, added = wire;
      lost.erase(lost.begin() + at);
      ASSERT_NO_FATAL_FAILURE(ExpectOnlyNext(lost));
      doubled.insert(doubled.begin() + at, wire[at]);
      ASSERT_NO_FATAL_FAILURE(ExpectOnlyNext(doubled));
      added.insert(added.begin() + at, static_cast<uint8_t>(random_() | 1));
      ASSERT_NO_FATAL_FAILURE(ExpectOnlyNext(added));
      std::swap(exchanged[at], exchanged[at + 1]);
      if (exchanged != wire) {
        ASSERT_NO_FATAL_FAILURE(ExpectOnlyNext(exchanged));
      }
    }
  }
}

// Tests that frames come through although the zero between them is lost or doubled.
TEST_F(FramesDamageTest, DelimitersLostOrDoubled) {
  const Bytes first = Wire(AnyFrame(HYDRO_SAMPLE, random_));
  Bytes stream(first.begin(), first.end() - 1);
  Append(&stream, next_);
  EXPECT_EQ(Received(stream), (std::vector<Bytes>{first, next_}));
  Bytes zeros = first;
  zeros.insert(zeros.end(), 1000, 0);
  Append(&zeros, next_);
  hydro_receiver receiver{};
  EXPECT_EQ(Received(zeros, &receiver), (std::vector<Bytes>{first, next_}));
  EXPECT_EQ(receiver.bad, 0U);
}

// Tests that a receiver survives any length without a zero, and begins anew when told to.
TEST_F(FramesDamageTest, NoEnd) {
  for (const size_t length : {200, 254, 255, 256, 257, 100000}) {
    hydro_receiver receiver{};
    Bytes stream(length, 0xFF);
    Append(&stream, next_);
    EXPECT_EQ(Received(stream, &receiver), std::vector<Bytes>{next_});
    EXPECT_EQ(receiver.bad, 1U);
  }
  hydro_receiver receiver{};
  EXPECT_TRUE(Received(Bytes(20, 1), &receiver).empty());
  hydro_receive_anew(&receiver);
  EXPECT_EQ(Received(Bytes(next_.begin() + 1, next_.end()), &receiver), std::vector<Bytes>{next_});
  EXPECT_EQ(receiver.bad, 0U);
}

// Tests streams at bit error rates from 1e-5 to 1e-2: what is found was sent, in order and once, and every
// frame whose bytes all arrived whole is found.
TEST_F(FramesDamageTest, BitErrorRates) {
  for (const double rate : {1e-5, 1e-4, 1e-3, 1e-2}) {
    std::bernoulli_distribution wrong(rate);
    hydro_receiver receiver{};
    size_t whole = 0, spoilt = 0;
    for (int frame = 0; frame < 3000; ++frame) {
      const Bytes wire = Wire(AnyFrame(kKinds[random_() % std::size(kKinds)], random_));
      Bytes arrived = wire;
      for (size_t bit = 0; bit < 8 * wire.size(); ++bit) {
        if (wrong(random_)) arrived[bit / 8] ^= static_cast<uint8_t>(1U << (bit % 8));
      }
      const std::vector<Bytes> found = Received(arrived, &receiver);
      if (arrived == wire) {
        ++whole;
        ASSERT_EQ(found, std::vector<Bytes>{wire});
      } else {
        ++spoilt;
        ASSERT_TRUE(found.empty());
      }
    }
    EXPECT_GT(spoilt, 0U);
    EXPECT_GT(whole, 0U);
    EXPECT_GT(receiver.bad, 0U);
  }
}

// Tests that noise is never taken for a frame: two million bytes, of which some are drawn to look like
// frames.
TEST_F(FramesDamageTest, Noise) {
  hydro_receiver receiver{};
  for (int piece = 0; piece < 40000; ++piece) {
    Bytes noise(random_() % 100);
    for (uint8_t& byte : noise) byte = static_cast<uint8_t>(random_() % 4 == 0 ? random_() % 20 : random_());
    noise.push_back(0);
    ASSERT_TRUE(Received(noise, &receiver).empty());
  }
  EXPECT_EQ(Received(next_, &receiver), std::vector<Bytes>{next_});
  EXPECT_GT(receiver.bad, 10000U);
}

}  // namespace
}  // namespace hydro::firmware
