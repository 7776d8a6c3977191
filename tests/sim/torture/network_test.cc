#include "sim/torture/machines/network.h"

#include <gtest/gtest.h>

namespace hydro::torture {
namespace {

class NetworkTest : public testing::Test {
 protected:
  struct Arrival {
    TrueTime time;
    PacketPtr packet;
    int receiver;
  };

  // Packets numbered by their first byte, from process 0 of role 0.
  void SendMany(int count) {
    for (int i = 0; i < count; ++i) {
      PacketPtr packet = network_.NewPacket();
      packet->bytes = {static_cast<uint8_t>(i), 0, 0, 0};
      packet->sender = 0;
      packet->origin = Origin::kProcess;
      network_.Send(packet, 0, {{0, 0}, {1, 1}});
      now_ += 1000;
    }
  }

  TrueTime now_ = 0;
  std::vector<Arrival> arrivals_;  // first: packets need the network's pool
  Network network_{7, &now_, [this](TrueTime time, PacketPtr packet, int receiver) {
                     arrivals_.push_back({time, std::move(packet), receiver});
                   }};
  void TearDown() override { arrivals_.clear(); }
};

TEST_F(NetworkTest, KeepsTheOrderOfASender) {
  SendMany(200);
  ASSERT_EQ(arrivals_.size(), 200u);
  for (size_t i = 1; i < arrivals_.size(); ++i) EXPECT_GE(arrivals_[i].time, arrivals_[i - 1].time);
  EXPECT_EQ(arrivals_[0].receiver, kEveryone);
}

TEST_F(NetworkTest, LosesOnlyWhatAFaultConcerns) {
  LinkFault fault;
  fault.loss = 1;
  fault.receiver = 1;
  const int number = network_.BeginFault(fault);
  SendMany(10);
  EXPECT_EQ(arrivals_.size(), 10u);
  EXPECT_EQ(network_.lost(), 10);
  network_.EndFault(number);
  SendMany(1);
  EXPECT_EQ(arrivals_.back().receiver, kEveryone);
}

TEST_F(NetworkTest, ChangesOneBitOfACopy) {
  LinkFault fault;
  fault.change = 1;
  fault.receiver = 1;
  network_.BeginFault(fault);
  SendMany(1);
  ASSERT_EQ(arrivals_.size(), 2u);
  EXPECT_EQ(arrivals_[0].packet->origin, Origin::kProcess);
  EXPECT_EQ(arrivals_[1].packet->origin, Origin::kChanged);
  int bits = 0;
  for (size_t i = 0; i < 4; ++i) {
    bits += __builtin_popcount(arrivals_[0].packet->bytes[i] ^ arrivals_[1].packet->bytes[i]);
  }
  EXPECT_EQ(bits, 1);
}

TEST_F(NetworkTest, RepeatsLaterThanTheFirst) {
  LinkFault fault;
  fault.repeat = 1;
  fault.delay_ns = 1'000'000;
  fault.receiver = 1;
  network_.BeginFault(fault);
  SendMany(20);
  int repeated = 0;
  for (const Arrival& arrival : arrivals_) repeated += arrival.packet->origin == Origin::kRepeated ? 1 : 0;
  EXPECT_EQ(repeated, 20);
}

TEST_F(NetworkTest, ForgetsAFaultWithItsEnd) {
  LinkFault fault;
  fault.delay_ns = 300'000'000;
  const int number = network_.BeginFault(fault);
  SendMany(1);
  network_.EndFault(number);
  SendMany(1);
  // Still in order: what was delayed comes first.
  EXPECT_GE(arrivals_.back().time, arrivals_.front().time);
}

}  // namespace
}  // namespace hydro::torture
