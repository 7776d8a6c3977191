// The example of a CiA 402 drive. There is no CAN on the machines that test this: a socket pair of the same
// kind of records, a struct can_frame each, stands for the CAN socket, and the test for the drive.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <vector>

#include "examples/own_driver/cia402/drive.h"

namespace cia402 {
namespace {

using hydro::plant::DeviceError;
using hydro::plant::DeviceReadings;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

constexpr uint8_t kNode = 5;

std::vector<int> Bytes(const can_frame& frame) { return {frame.data, frame.data + frame.can_dlc}; }

class Cia402Test : public ::testing::Test {
 protected:
  Cia402Test() {
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_NONBLOCK, 0, ends) != 0)
      throw std::runtime_error("no sockets");
    ours_ = ends[0];
    drives_ = ends[1];
  }
  ~Cia402Test() override { close(drives_); }

  void Say(const can_frame& frame) const { ASSERT_EQ(send(drives_, &frame, sizeof frame, 0), sizeof frame); }

  // What has come on the bus so far.
  std::vector<can_frame> Heard() const {
    std::vector<can_frame> frames;
    can_frame frame;
    while (recv(drives_, &frame, sizeof frame, 0) == sizeof frame) frames.push_back(frame);
    return frames;
  }

  // The drive, which has answered the request for torque mode with this frame.
  std::unique_ptr<CanDrive> Open(const can_frame& answer) {
    Say(answer);
    return std::make_unique<CanDrive>(ours_, kNode, "can0 node 5", clock_, true);
  }
  std::unique_ptr<CanDrive> Open() {
    return Open(Frame(0x580u + kNode, uint8_t{0x60}, uint16_t{0x6060}, uint8_t{0}, uint32_t{0}));
  }

  void Status(uint16_t statusword, int16_t torque = 0, int32_t position = 0) const {
    Say(Frame(0x180u + kNode, statusword, torque, position));
  }

  DeviceReadings Read(CanDrive& drive) const {
    DeviceReadings readings;
    readings.inputs.resize(drive.Describe().inputs.size());
    drive.Read(readings);
    return readings;
  }

  hydro::bus::WallClock clock_;
  int ours_, drives_;
};

// Tests, byte by byte, what is said at the start: the node is started, an old fault reset, torque mode set.
TEST_F(Cia402Test, Start) {
  const auto drive = Open();
  const std::vector<can_frame> frames = Heard();
  ASSERT_EQ(frames.size(), 3u);
  EXPECT_EQ(frames[0].can_id, 0u);
  EXPECT_THAT(Bytes(frames[0]), ElementsAre(1, 5));
  EXPECT_EQ(frames[1].can_id, 0x205u);
  EXPECT_THAT(Bytes(frames[1]), ElementsAre(0x80, 0, 0, 0));
  EXPECT_EQ(frames[2].can_id, 0x605u);
  EXPECT_THAT(Bytes(frames[2]), ElementsAre(0x2f, 0x60, 0x60, 0, 4, 0, 0, 0));
}

// Tests that a drive without torque mode, and one that does not answer, are errors that say what to look at.
TEST_F(Cia402Test, RefusesTorqueMode) {
  try {
    Open(Frame(0x580u + kNode, uint8_t{0x80}, uint16_t{0x6060}, uint8_t{0}, uint32_t{0x06090030}));
    FAIL();
  } catch (const DeviceError& error) {
    EXPECT_THAT(error.what(),
                HasSubstr("can0 node 5 refuses torque mode (0x6060 = 4), abort code 0x6090030"));
  }
}
TEST_F(Cia402Test, DoesNotAnswer) {
  try {
    Open(
        Frame(0x580u + kNode + 1, uint8_t{0x60}, uint16_t{0x6060}, uint8_t{0}, uint32_t{0}));  // another node
    FAIL();
  } catch (const DeviceError& error) {
    EXPECT_THAT(error.what(), HasSubstr("is driver.own.node its number"));
  }
}

// Tests that the drive is led to "operation enabled" a step at a time, with no torque before it is there.
TEST_F(Cia402Test, StepsToEnabled) {
  const auto drive = Open();
  Heard();
  const std::pair<uint16_t, std::vector<int>> steps[] = {{0x0240, {0x06, 0, 0, 0}},
                                                         {0x0221, {0x07, 0, 0, 0}},
                                                         {0x0223, {0x0f, 0, 0, 0}},
                                                         {0x0227, {0x0f, 0, 0x38, 0xff}}};
  for (const auto& [statusword, command] : steps) {
    Status(statusword);
    Read(*drive);
    drive->Drive(-200);
    const std::vector<can_frame> frames = Heard();
    EXPECT_EQ(frames[0].can_id, 0x205u);
    EXPECT_EQ(Bytes(frames[0]), command) << statusword;
    EXPECT_EQ(frames.back().can_id, 0x80u);
    EXPECT_TRUE(Bytes(frames.back()).empty());
    EXPECT_EQ(frames.size(), statusword == 0x0240 ? 3u : 2u);
    if (frames.size() != 3) continue;  // a heartbeat in every tenth tick
    EXPECT_EQ(frames[1].can_id, 0x77fu);
    EXPECT_THAT(Bytes(frames[1]), ElementsAre(5));
  }
}

// Tests that a drive in a fault is asked for nothing, and that its fault and its emergencies are told.
TEST_F(Cia402Test, Fault) {
  const auto drive = Open();
  Heard();
  Status(0x0208);
  EXPECT_EQ(Read(*drive).fault, "the state fault (statusword 0x0208)");
  drive->Drive(300);
  EXPECT_THAT(Bytes(Heard()[0]), ElementsAre(0x06, 0, 0, 0));
  Say(Frame(0x080u + kNode, uint16_t{0x2310}, uint8_t{1}, uint32_t{0}, uint8_t{0}));
  EXPECT_EQ(Read(*drive).fault, "emergency 0x2310");
  Say(Frame(0x080u + kNode, uint16_t{0}, uint8_t{0}, uint32_t{0}, uint8_t{0}));
  Status(0x0240);
  EXPECT_EQ(Read(*drive).fault, "");
}

// Tests that a drive which has started anew in the run, and so may be in another mode than torque, is a fault
// that stays, and is never enabled again.
TEST_F(Cia402Test, StartsAnew) {
  const auto drive = Open();
  Status(0x0227);
  Say(Frame(0x700u + kNode + 1, uint8_t{0}));  // another node
  Say(Frame(0x700u + kNode, uint8_t{5}));      // a heartbeat
  EXPECT_EQ(Read(*drive).fault, "");
  Say(Frame(0x700u + kNode, uint8_t{0}));
  for (const uint16_t statusword : {0x0240, 0x0221, 0x0223, 0x0227}) {
    Status(statusword);
    EXPECT_THAT(Read(*drive).fault, HasSubstr("it has started anew"));
    Heard();
    drive->Drive(0);
    EXPECT_THAT(Bytes(Heard().at(0)), ElementsAre(0x06, 0, 0, 0));
  }
}

// Tests every value of the frames, signs included, that the newest counts, and that others' frames say
// nothing.
TEST_F(Cia402Test, Readings) {
  const auto drive = Open();
  Status(0x0227, 7, 1);
  Status(0x0227, -150, -2);
  Say(Frame(0x280u + kNode, int32_t{-70000}, int16_t{-1500}, int16_t{2500}));
  Say(Frame(0x380u + kNode, int16_t{9999}));
  Say(Frame(0x180u + kNode + 1, uint16_t{0x0208}, int16_t{1}, int32_t{1}));
  Say(Frame(0x180u + kNode, uint16_t{0x0208}));  // too short
  const DeviceReadings readings = Read(*drive);
  std::vector<double> values;
  for (const hydro::plant::Reading& reading : readings.inputs) values.push_back(reading.value);
  EXPECT_THAT(values, ElementsAre(4294967294.0, -70000, -1.5, 2.5, 9.999));
  EXPECT_EQ(readings.output.value, -150);
  EXPECT_EQ(readings.fault, "");
}

// Tests that the times of readings are those of their frames: what does not come grows old.
TEST_F(Cia402Test, OldReadings) {
  const auto drive = Open();
  drive->Drive(0);  // asks the drive to measure
  const auto asked = clock_.Now();
  Status(0x0227);
  const auto before = Read(*drive).inputs[0].at;
  EXPECT_LE(before, asked);
  EXPECT_EQ(Read(*drive).inputs[0].at, before);
  EXPECT_EQ(Read(*drive).inputs[1].at, hydro::bus::Clock::TimePoint{}) << "that frame has never come";
  drive->Drive(0);
  Status(0x0227);
  EXPECT_GT(Read(*drive).inputs[0].at, before);
}

// Tests that zero is the power stage off, and what is read back is the torque that the drive answers then,
// not what it had answered before.
TEST_F(Cia402Test, Zero) {
  const auto drive = Open();
  Heard();
  EXPECT_TRUE(drive->Zero(0));
  EXPECT_THAT(Bytes(Heard().at(0)), ElementsAre(0x06, 0, 0, 0));
  Status(0x0227, 200);
  Status(0x0221, 3);
  EXPECT_EQ(drive->ReadBack(), 3);
  Status(0x0227, 200);  // and so it stays
  EXPECT_EQ(drive->ReadBack(), 200);
}

// Tests that a bus that has gone is an error of the device, not a silence.
TEST_F(Cia402Test, BusGone) {
  const auto drive = Open();
  shutdown(drives_, SHUT_RDWR);
  EXPECT_THROW(drive->Drive(1), DeviceError);
  EXPECT_FALSE(drive->Zero(0));
}

}  // namespace
}  // namespace cia402
