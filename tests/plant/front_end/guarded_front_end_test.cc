// What the guardian of a driver behind a front end does when the driver is killed.
#include "plant/driver/guarded_front_end.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <optional>
#include <string>

#include "base/text_file.h"
#include "firmware/device.h"
#include "tests/plant/front_end/device_bench.h"

namespace hydro::plant {
namespace {

constexpr int kPatience_ms = 10000;

// A device at the end of a UDP socket, and its driver, a process that can be killed.
class GuardedFrontEndTest : public ::testing::Test {
 protected:
  GuardedFrontEndTest() : socket_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in here{};
    here.sin_family = AF_INET;
    here.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t length = sizeof here;
    EXPECT_EQ(bind(socket_, reinterpret_cast<sockaddr*>(&here), length), 0);
    EXPECT_EQ(getsockname(socket_, reinterpret_cast<sockaddr*>(&here), &length), 0);
    url_ = "udp://127.0.0.1:" + std::to_string(ntohs(here.sin_port));
    prctl(PR_SET_CHILD_SUBREAPER, 1);  // the guardian's end is seen here
    facts_ = bench_.facts;
    facts_.datagrams = true;
    hydro_device_begin(&device_, &facts_);
  }
  ~GuardedFrontEndTest() override {
    prctl(PR_SET_CHILD_SUBREAPER, 0);
    close(socket_);
  }

  pid_t StartDriver() {
    const settings::StackConfig config = settings::ParseStackConfig(
        settings::kConfigText + settings::Replaced(kFrontEndText, "udp://127.0.0.1:7", url_), "stack.toml",
        settings::kModelText, "model.toml");
    const pid_t driver = fork();
    if (driver == 0) {
      bus::WallClock clock;
      const GuardedFrontEnd rig(config, clock);
      for (;;) pause();
    }
    return driver;
  }

  // The next frame of the driver within this time.
  std::optional<hydro_frame> Next(int patience_ms) {
    pollfd wait{.fd = socket_, .events = POLLIN, .revents = 0};
    if (poll(&wait, 1, patience_ms) != 1) return std::nullopt;
    Bytes packet(512);
    socklen_t length = sizeof driver_;
    const ssize_t got =
        recvfrom(socket_, packet.data(), packet.size(), 0, reinterpret_cast<sockaddr*>(&driver_), &length);
    hydro_receiver receiver{};
    hydro_frame frame{};
    for (ssize_t i = 0; i < got; ++i) {
      hydro_device_receive(&device_, packet[static_cast<size_t>(i)]);
      if (hydro_receive(&receiver, packet[static_cast<size_t>(i)], &frame)) return frame;
    }
    return std::nullopt;
  }

  // The device takes a tick and answers what has come. Returns the frame that came.
  std::optional<hydro_frame> RunDevice() {
    const std::optional<hydro_frame> frame = Next(1);
    hydro_device_tick(&device_, &bench_.readings);
    uint8_t wire[HYDRO_WIRE_MAX];
    while (const size_t count = hydro_device_send(&device_, wire))
      sendto(socket_, wire, count, 0, reinterpret_cast<sockaddr*>(&driver_), sizeof driver_);
    return frame;
  }
  bool RunDeviceUntil(uint8_t kind) {
    for (int i = 0; i < kPatience_ms; ++i) {
      const std::optional<hydro_frame> frame = RunDevice();
      if (frame && frame->kind == kind) return true;
    }
    return false;
  }

  // How many ZEROs come after the driver has been killed, from it and its guardian, until both have ended.
  int ZerosAfterKill(pid_t driver) {
    kill(driver, SIGKILL);
    while (waitpid(-1, nullptr, 0) > 0) {
    }
    int zeros = 0;
    while (const std::optional<hydro_frame> frame = Next(0)) zeros += frame->kind == HYDRO_ZERO;
    return zeros;
  }

  DeviceBench bench_;  // for its facts and readings
  int socket_;
  std::string url_;
  sockaddr_in driver_{};
  hydro_board_facts facts_{};
  hydro_device device_{};
};

// Tests that the guardian of a driver whose device was up asks for zero volts.
TEST_F(GuardedFrontEndTest, AsksForZero) {
  const pid_t driver = StartDriver();
  ASSERT_TRUE(RunDeviceUntil(HYDRO_SETTINGS));
  // The guardian is there from the first sample on.
  const std::string children =
      "/proc/" + std::to_string(driver) + "/task/" + std::to_string(driver) + "/children";
  for (int i = 0; i < kPatience_ms && ReadTextFile(children).empty(); ++i) RunDevice();
  EXPECT_EQ(ZerosAfterKill(driver), 1);
}

// Tests that a driver that waits for a device which another one commands leaves that one its volts when it is
// killed, whether it has heard so already or not.
TEST_F(GuardedFrontEndTest, LeavesWhatAnotherCommands) {
  for (const bool heard : {false, true}) {
    hydro_device_begin(&device_, &facts_);
    device_.session = 0x99;  // and heard a moment ago
    const pid_t driver = StartDriver();
    if (heard) {
      ASSERT_TRUE(RunDeviceUntil(HYDRO_HELLO));
      ASSERT_TRUE(RunDeviceUntil(HYDRO_HELLO)) << "it is refused, and asks again";
    } else {
      ASSERT_TRUE(Next(kPatience_ms));
    }
    EXPECT_EQ(ZerosAfterKill(driver), 0) << heard;
  }
}

}  // namespace
}  // namespace hydro::plant
