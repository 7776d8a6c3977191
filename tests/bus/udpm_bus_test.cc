#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sched.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <memory>
#include <vector>

#include "base/input_error.h"
#include "bus/udpm/open_udpm_bus.h"
#include "hydro/state_t.hpp"
#include "tests/free_udp_port.h"

namespace hydro::bus {
namespace {

using namespace std::chrono_literals;
using testing::HasSubstr;

Bus::TimePoint Soon(std::chrono::nanoseconds delay) { return std::chrono::steady_clock::now() + delay; }

class UdpmBusTest : public testing::Test {
 protected:
  UdpmBus& Open(const std::string& url) { return *opened_.emplace_back(OpenUdpmBus(url)); }

 private:
  std::vector<std::unique_ptr<UdpmBus>> opened_;
};

// Tests that of two buses on one port and one on another port, in the same group, only the first two hear
// each other.
TEST_F(UdpmBusTest, PortsSeparate) {
  const std::string url = FreeBusUrl();
  UdpmBus &one = Open(url), &two = Open(url), &other = Open(FreeBusUrl());
  int heard = 0;
  int others_heard = 0;
  two.Subscribe<state_t>("STATE", [&](const state_t&) { ++heard; });
  other.SubscribeAll([&](const RawMessage&) { ++others_heard; });
  one.Publish("STATE", state_t{});
  EXPECT_EQ(two.HandleUntil(Soon(10s)), 1);
  EXPECT_EQ(heard, 1);
  other.HandleUntil(Soon(20ms));
  EXPECT_EQ(others_heard, 0);
}

// Tests that the self tests of starting processes are not passed on as messages.
TEST_F(UdpmBusTest, SelfTestsAreNotMessages) {
  const std::string url = FreeBusUrl();
  UdpmBus& bus = Open(url);
  std::vector<std::string> seen;
  bus.SubscribeAll([&](const RawMessage& message) { seen.emplace_back(message.channel); });
  UdpmBus& late = Open(url);
  late.Publish("STATE", state_t{});
  EXPECT_EQ(bus.HandleUntil(Soon(10s)), 1);
  EXPECT_THAT(seen, testing::ElementsAre("STATE"));
}

void OnAlarm(int) {}

// Tests that a signal ends HandleUntil() early with 0, so that main can look at its stop flag.
TEST_F(UdpmBusTest, SignalEndsTheWait) {
  UdpmBus& bus = Open(FreeBusUrl());
  struct sigaction action {};
  action.sa_handler = OnAlarm;
  sigaction(SIGALRM, &action, nullptr);
  itimerval repeatedly{};
  repeatedly.it_value.tv_usec = repeatedly.it_interval.tv_usec = 10'000;
  setitimer(ITIMER_REAL, &repeatedly, nullptr);
  const auto deadline = Soon(100s);
  EXPECT_EQ(bus.HandleUntil(deadline), 0);
  EXPECT_LT(std::chrono::steady_clock::now(), deadline);
  const itimerval off{};
  setitimer(ITIMER_REAL, &off, nullptr);
}

// Tests that what can be read elsewhere ends the wait too, that messages are handled all the same, and that
// it no longer does once it is not asked for.
TEST_F(UdpmBusTest, WakesOnADescriptor) {
  UdpmBus& bus = Open(FreeBusUrl());
  int pipe_ends[2];
  ASSERT_EQ(pipe2(pipe_ends, O_CLOEXEC), 0);
  bus.WakeOn(pipe_ends[0]);
  EXPECT_EQ(bus.HandleUntil(Soon(1ms)), 0) << "there is nothing yet";
  ASSERT_EQ(write(pipe_ends[1], "x", 1), 1);
  const auto deadline = Soon(100s);
  EXPECT_EQ(bus.HandleUntil(deadline), 0);
  EXPECT_LT(std::chrono::steady_clock::now(), deadline);
  int handled = 0;
  bus.Subscribe<state_t>("HYDRO_STATE", [&](const state_t&) { ++handled; });
  bus.Publish("HYDRO_STATE", state_t{});
  while (handled == 0 && std::chrono::steady_clock::now() < deadline) bus.HandleUntil(deadline);
  EXPECT_EQ(handled, 1);
  bus.WakeOn(-1);
  const auto soon = Soon(20ms);
  EXPECT_EQ(bus.HandleUntil(soon), 0);
  EXPECT_GE(std::chrono::steady_clock::now(), soon);
  close(pipe_ends[0]);
  close(pipe_ends[1]);
}

// Tests that a channel name that LCM cannot carry is refused, for sending and for listening.
TEST_F(UdpmBusTest, RefusesImpossibleChannels) {
  UdpmBus& bus = Open(FreeBusUrl());
  EXPECT_NO_THROW(bus.Publish(std::string(63, 'c'), state_t{}));
  EXPECT_THROW(bus.Publish(std::string(64, 'c'), state_t{}), BusError);
  EXPECT_THROW(bus.Publish("", state_t{}), BusError);
  EXPECT_THROW(bus.PublishRaw(std::string(64, 'c'), "x", 1), BusError);
  EXPECT_THROW(bus.Subscribe<state_t>(std::string(64, 'c'), [](const state_t&) {}), BusError);
}

// Tests that a bad URL is an input error, before anything is opened.
TEST(OpenUdpmBusTest, BadUrlIsAnInputError) {
  EXPECT_THROW(OpenUdpmBus("udp://239.255.76.67:7667"), InputError);
  EXPECT_THROW(OpenUdpmBus("udpm://10.0.0.1:7667"), InputError);
}

// Tests that a small receive buffer is reported together with how to enlarge it, and a sufficient one is not.
TEST_F(UdpmBusTest, ReportsTheReceiveBuffer) {
  UdpmBus& small = Open(FreeBusUrl() + "&recv_buf_size=8192");
  EXPECT_GE(small.receive_buffer_bytes(), 8192);
  EXPECT_EQ(small.receive_buffer_hint(), "");
  UdpmBus& huge = Open(FreeBusUrl() + "&recv_buf_size=1073741824");  // no machine allows this much
  EXPECT_GT(huge.receive_buffer_bytes(), 0);
  EXPECT_THAT(huge.receive_buffer_hint(), HasSubstr("sysctl -w net.core.rmem_max=1073741824"));
}

// Tests that the error names a port that another program holds exclusively.
TEST(OpenUdpmBusTest, TakenPortIsABusError) {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  socklen_t length = sizeof address;
  ASSERT_EQ(bind(fd, reinterpret_cast<sockaddr*>(&address), length), 0);
  ASSERT_EQ(getsockname(fd, reinterpret_cast<sockaddr*>(&address), &length), 0);
  try {
    OpenUdpmBus("udpm://239.255.76.67:" + std::to_string(ntohs(address.sin_port)));
    ADD_FAILURE() << "the port was accepted";
  } catch (const BusError& error) {
    EXPECT_THAT(error.what(), HasSubstr("choose another port"));
  }
  close(fd);
}

// Tests that a machine without a multicast route gives one line with the remedy. Runs in a child process,
// which moves into a network namespace of its own without any route.
TEST(OpenUdpmBusTest, NoRouteIsABusErrorWithTheCure) {
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    if (unshare(CLONE_NEWNET) != 0 && unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) _exit(77);
    try {
      OpenUdpmBus("udpm://239.255.76.67:7667?ttl=0");
    } catch (const BusError& error) {
      const std::string what = error.what();
      const bool good =
          what.find("ip route add 224.0.0.0/4 dev lo") != what.npos && what.find('\n') == what.npos;
      if (!good) fprintf(stderr, "%s\n", error.what());
      _exit(good ? 0 : 1);
    }
    _exit(2);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  ASSERT_TRUE(WIFEXITED(status));
  if (WEXITSTATUS(status) == 77) GTEST_SKIP() << "network namespaces are not permitted here";
  EXPECT_EQ(WEXITSTATUS(status), 0) << "1: the message lacks the cure, 2: no error";
}

// Tests that a group from which nothing comes back is noticed within the timeout and named: it sends to one
// port and waits no time at all.
TEST(OpenUdpmBusTest, SilenceIsABusError) {
  UdpmUrl url;
  url.port = static_cast<uint16_t>(FreeUdpPort());
  try {
    TestMulticast(url, 0ms);
    ADD_FAILURE() << "the test passed without waiting";
  } catch (const BusError& error) {
    EXPECT_THAT(error.what(), HasSubstr("did not come back"));
    EXPECT_THAT(error.what(), HasSubstr("firewall"));
  }
}

}  // namespace
}  // namespace hydro::bus
