#include "plant/front_end/link.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <filesystem>
#include <numeric>

#include "tests/plant/front_end/pseudo_terminal.h"

namespace hydro::plant {
namespace {

using ::testing::HasSubstr;
using Bytes = std::vector<uint8_t>;

std::unique_ptr<Link> LinkTo(const std::string& url) {
  settings::FrontEndUrl parsed;
  EXPECT_EQ(settings::WhatIsWrongWithFrontEndUrl(url, &parsed), "");
  return MakeLink(parsed);
}

Bytes Numbered(size_t count) {
  Bytes bytes(count);
  std::iota(bytes.begin(), bytes.end(), uint8_t{0});
  return bytes;
}

// What has come so far, at least `count` bytes: the kernel hands them over in its own time, within this
// process's calls.
Bytes ReadSome(Link& link, size_t count) {
  Bytes all, some(4096);
  for (int tries = 0; tries < 10000 && all.size() < count; ++tries) {
    some.resize(4096);
    some.resize(link.Read(some));
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

// Tests that a serial link carries every byte both ways unchanged, control characters too.
TEST(LinkTest, SerialIsRaw) {
  const PseudoTerminal terminal;
  const auto link = LinkTo("serial:" + terminal.path() + "?baud=1000000");
  ASSERT_TRUE(link->Open()) << link->trouble().found;
  const Bytes all = Numbered(256);
  terminal.Send(all);
  EXPECT_EQ(ReadSome(*link, 256), all);
  Bytes none(8);
  EXPECT_EQ(link->Read(none), 0U);
  EXPECT_TRUE(link->is_open());
  link->Write(all);
  EXPECT_EQ(terminal.Receive(), all);
}

// Tests that a second driver on the same port is refused, and that the port is free again after the first.
TEST(LinkTest, BusyPort) {
  const PseudoTerminal terminal;
  const auto first = LinkTo("serial:" + terminal.path());
  const auto second = LinkTo("serial:" + terminal.path());
  ASSERT_TRUE(first->Open());
  EXPECT_FALSE(second->Open());
  EXPECT_THAT(second->trouble().found, HasSubstr(terminal.path() + "\" (Device or resource busy)"));
  EXPECT_THAT(second->trouble().allowed, HasSubstr("fuser -v " + terminal.path()));
  first->Close();
  EXPECT_TRUE(second->Open());
}

// Tests what is said of ports that are not there, are something else, or may not be used.
TEST(LinkTest, WhatIsNoPort) {
  const auto absent = LinkTo("serial:/dev/ttyNone7");
  EXPECT_FALSE(absent->Open());
  EXPECT_EQ(absent->trouble().found, "\"/dev/ttyNone7\" (No such file or directory)");
  EXPECT_THAT(absent->trouble().allowed, HasSubstr("is the device plugged in?"));
  const auto other = LinkTo("serial:/dev/null");
  EXPECT_FALSE(other->Open());
  EXPECT_EQ(other->trouble().found, "\"/dev/null\", which is no serial port");
  const auto folder = LinkTo("serial:/dev/pts");
  EXPECT_FALSE(folder->Open());
  EXPECT_THAT(folder->trouble().found, HasSubstr("Is a directory"));
}

// Tests that a port without permission says which group has it. Root may use every port.
TEST(LinkTest, NoPermission) {
  if (geteuid() == 0 && seteuid(65534) != 0) GTEST_SKIP() << "cannot give up root's rights here";
  const std::string path = std::filesystem::temp_directory_path() / ("port_" + std::to_string(getpid()));
  {
    const int file = open(path.c_str(), O_CREAT | O_CLOEXEC, 0000);
    close(file);
  }
  const auto link = LinkTo("serial:" + path);
  const bool opened = link->Open();
  unlink(path.c_str());
  const bool back = getuid() != 0 || seteuid(0) == 0;
  EXPECT_TRUE(back);
  EXPECT_FALSE(opened);
  EXPECT_THAT(link->trouble().found, HasSubstr("Permission denied"));
  EXPECT_THAT(link->trouble().allowed, HasSubstr("usermod -aG dialout"));
}

// Tests that an unplugged port closes the link, and that it can be opened again once it is back.
TEST(LinkTest, UnpluggedAndBack) {
  auto terminal = std::make_unique<PseudoTerminal>();
  const std::string path = std::filesystem::temp_directory_path() / ("cable_" + std::to_string(getpid()));
  std::filesystem::create_symlink(terminal->path(), path);
  const auto link = LinkTo("serial:" + path);
  ASSERT_TRUE(link->Open());
  terminal->Unplug();
  Bytes some(8);
  EXPECT_EQ(link->Read(some), 0U);
  EXPECT_FALSE(link->is_open());
  link->Write(some);  // into nothing
  EXPECT_FALSE(link->Open());
  std::filesystem::remove(path);
  terminal = std::make_unique<PseudoTerminal>();
  std::filesystem::create_symlink(terminal->path(), path);
  EXPECT_TRUE(link->Open());
  terminal->Send({1, 2, 3});
  EXPECT_EQ(ReadSome(*link, 3), (Bytes{1, 2, 3}));
  std::filesystem::remove(path);
}

// Tests that a device that takes nothing makes nobody wait, and that what it takes afterwards is the newest
// frame, whole, behind the one that was on its way.
TEST(LinkTest, NeverBehindByMoreThanOneFrame) {
  const std::string path = std::filesystem::temp_directory_path() / ("slow_" + std::to_string(getpid()));
  unlink(path.c_str());
  const int server = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0);
  sockaddr_un address = {};
  address.sun_family = AF_UNIX;
  path.copy(address.sun_path, sizeof address.sun_path - 1);
  ASSERT_EQ(bind(server, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
  ASSERT_EQ(listen(server, 1), 0);
  const auto link = LinkTo("unix:" + path);
  ASSERT_TRUE(link->Open()) << link->trouble().found;
  const int device = accept4(server, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
  ASSERT_GE(device, 0);

  constexpr size_t kFrame = 40000;
  int written = 0;
  while (link->frames_left_out() < 10) link->Write(Bytes(kFrame, static_cast<uint8_t>(written++)));
  Bytes taken, some(65536);
  for (int quiet = 0; quiet < 3;) {
    const ssize_t got = read(device, some.data(), some.size());
    quiet = got > 0 ? 0 : quiet + 1;
    if (got > 0) taken.insert(taken.end(), some.begin(), some.begin() + got);
    link->Flush();
  }
  ASSERT_EQ(taken.size() % kFrame, 0U);
  const size_t frames = taken.size() / kFrame;
  EXPECT_EQ(frames, 2U) << "one on its way, and the newest";
  EXPECT_EQ(static_cast<int>(frames) + link->frames_left_out(), written);
  for (size_t i = 0; i < taken.size(); ++i) {
    const size_t frame = i / kFrame;
    const auto expected = static_cast<uint8_t>(frame + 1 < frames ? frame : written - 1);
    ASSERT_EQ(taken[i], expected) << i;
  }

  // One that found the line busy is not sent in the place of the next: that would put each behind the other.
  const auto take_all = [&] {
    for (int quiet = 0; quiet < 3;) quiet = read(device, some.data(), some.size()) > 0 ? 0 : quiet + 1;
  };
  link->Write(Bytes(5, 1));
  link->Write(Bytes(5, 2));  // nothing was taken yet
  for (uint8_t tick = 3; tick < 6; ++tick) {
    take_all();
    link->Write(Bytes(5, tick));
    ASSERT_EQ(read(device, some.data(), some.size()), 5) << "it left at once";
    EXPECT_EQ(some[0], tick);
  }

  // What must leave is not replaced by what is sent in each tick.
  link->Write(Bytes(kFrame, 1));
  link->Write(Bytes(5, 2), /*must_leave=*/true);
  link->Write(Bytes(kFrame, 3));
  taken.clear();
  for (int quiet = 0; quiet < 3;) {
    const ssize_t got = read(device, some.data(), some.size());
    quiet = got > 0 ? 0 : quiet + 1;
    if (got > 0) taken.insert(taken.end(), some.begin(), some.begin() + got);
    link->Flush();
  }
  ASSERT_EQ(taken.size(), kFrame + 5);
  EXPECT_EQ(taken.back(), 2);
  close(device);
  link->Write(some);
  link->Write(some);
  EXPECT_FALSE(link->is_open()) << "and no SIGPIPE has ended this process";
  close(server);
  EXPECT_FALSE(link->Open());
  EXPECT_THAT(link->trouble().found, HasSubstr("Connection refused"));
  unlink(path.c_str());
  EXPECT_FALSE(link->Open());
  EXPECT_THAT(link->trouble().allowed, HasSubstr("has it been started?"));
}

// Tests that datagrams arrive whole and in order, that those of strangers do not, and that an absent device
// is silence.
TEST(LinkTest, Udp) {
  const int device = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  sockaddr_in here = {};
  here.sin_family = AF_INET;
  here.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  socklen_t length = sizeof here;
  ASSERT_EQ(bind(device, reinterpret_cast<sockaddr*>(&here), sizeof here), 0);
  ASSERT_EQ(getsockname(device, reinterpret_cast<sockaddr*>(&here), &length), 0);
  const auto link = LinkTo("udp://127.0.0.1:" + std::to_string(ntohs(here.sin_port)));
  ASSERT_TRUE(link->Open());
  link->Write(Bytes{7, 8, 9});
  Bytes some(64);
  sockaddr_in driver = {};
  ASSERT_EQ(recvfrom(device, some.data(), some.size(), 0, reinterpret_cast<sockaddr*>(&driver), &length), 3);
  const int stranger = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const auto send_to_driver = [&](int from, const Bytes& bytes) {
    sendto(from, bytes.data(), bytes.size(), 0, reinterpret_cast<sockaddr*>(&driver), sizeof driver);
  };
  EXPECT_EQ(link->HeardElsewhere(), "");
  send_to_driver(stranger, {66});
  sockaddr_in elsewhere = {};
  ASSERT_EQ(getsockname(stranger, reinterpret_cast<sockaddr*>(&elsewhere), &length), 0);
  const std::string from = "127.0.0.1:" + std::to_string(ntohs(elsewhere.sin_port));
  EXPECT_EQ(link->HeardElsewhere(), from) << "it is known from where it came, and not used";
  EXPECT_EQ(link->HeardElsewhere(), "") << "once";
  send_to_driver(stranger, {66});
  send_to_driver(device, {1, 2});
  send_to_driver(device, {});
  send_to_driver(device, {3});
  EXPECT_EQ(ReadSome(*link, 3), (Bytes{1, 2, 3}));
  // More than are read at once, as after this process stood still: none is cut off.
  for (int i = 0; i < 100; ++i) send_to_driver(device, Bytes(107, 5));
  size_t all = 0;
  Bytes chunk(4096);
  while (const size_t count = link->Read(chunk)) all += count;
  EXPECT_EQ(all, 100U * 107);

  // None is cut where a read ends, nor one that is longer than a read.
  Bytes sent, got;
  for (const size_t size : {size_t{40}, size_t{41}, size_t{1}, size_t{200}, size_t{63}}) {
    send_to_driver(device, Numbered(size));
    const Bytes one = Numbered(size);
    sent.insert(sent.end(), one.begin(), one.end());
  }
  for (int tries = 0; tries < 10000 && got.size() < sent.size(); ++tries) {
    const size_t count = link->Read(some);
    got.insert(got.end(), some.begin(), some.begin() + static_cast<std::ptrdiff_t>(count));
  }
  EXPECT_EQ(got, sent);

  // A flood of empty ones holds no read, and hides nothing.
  for (int i = 0; i < 150; ++i) send_to_driver(device, {});
  send_to_driver(device, {4});
  EXPECT_EQ(link->Read(some), 0U) << "no more than a bounded number in one read";
  EXPECT_EQ(ReadSome(*link, 1), Bytes{4});
  close(device);
  close(stranger);
  for (int i = 0; i < 5; ++i) {
    link->Write(Bytes{1});
    EXPECT_EQ(link->Read(some), 0U);
  }
  EXPECT_TRUE(link->is_open());
  const int thief = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const int shares = 1;
  setsockopt(thief, SOL_SOCKET, SO_REUSEPORT, &shares, sizeof shares);
  EXPECT_NE(bind(thief, reinterpret_cast<sockaddr*>(&driver), sizeof driver), 0) << "nobody shares the port";
  close(thief);
  const auto nowhere = LinkTo("udp://no-such-host.invalid:7");
  EXPECT_FALSE(nowhere->Open());
  EXPECT_THAT(nowhere->trouble().found, HasSubstr("\"no-such-host.invalid\" ("));
}

}  // namespace
}  // namespace hydro::plant
