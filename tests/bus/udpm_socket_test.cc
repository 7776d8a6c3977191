#include "bus/udpm/udpm_socket.h"

#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <lcm/lcm.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <string>
#include <vector>

#include "tests/free_udp_port.h"

namespace hydro::bus {
namespace {

using namespace std::chrono_literals;
using testing::ElementsAre;

// liblcm as the other end: what it sends and understands defines the format.
class Lcm {
 public:
  explicit Lcm(const std::string& url) : lcm_(lcm_create(url.c_str())) {
    subscription_ = lcm_subscribe(lcm_, ".*", &Lcm::OnMessage, this);
    lcm_subscription_set_queue_capacity(subscription_, 0);
  }
  ~Lcm() { lcm_destroy(lcm_); }
  Lcm(const Lcm&) = delete;
  Lcm& operator=(const Lcm&) = delete;

  void Send(const std::string& channel, const std::string& data) {
    ASSERT_EQ(lcm_publish(lcm_, channel.c_str(), data.data(), static_cast<unsigned>(data.size())), 0);
  }

  // The next message, other than LCM's own self tests.
  std::pair<std::string, std::string> Next() {
    const auto give_up = std::chrono::steady_clock::now() + 10s;
    while (seen_.empty() && std::chrono::steady_clock::now() < give_up) lcm_handle_timeout(lcm_, 100);
    if (seen_.empty()) return {"nothing came", ""};
    auto first = seen_.front();
    seen_.erase(seen_.begin());
    return first;
  }

 private:
  static void OnMessage(const lcm_recv_buf_t* buffer, const char* channel, void* self) {
    if (std::string(channel) == "LCM_SELF_TEST") return;
    static_cast<Lcm*>(self)->seen_.emplace_back(
        channel, std::string(static_cast<const char*>(buffer->data), buffer->data_size));
  }

  lcm_t* lcm_;
  lcm_subscription_t* subscription_;
  std::vector<std::pair<std::string, std::string>> seen_;
};

// Waits for a message and returns "channel: size of the data", or says what came instead.
std::string Next(UdpmSocket& socket, std::string* data = nullptr) {
  const auto give_up = std::chrono::steady_clock::now() + 10s;
  UdpmSocket::Message message;
  while (std::chrono::steady_clock::now() < give_up) {
    pollfd waiting{socket.fd(), POLLIN, 0};
    poll(&waiting, 1, 100);
    if (!socket.Receive(&message)) continue;
    if (data != nullptr) data->assign(reinterpret_cast<const char*>(message.data), message.size);
    return message.channel;
  }
  return "nothing came";
}

// A text of `size` bytes, zeros included, without repetition.
std::string Text(size_t size) {
  std::string text(size, ' ');
  for (size_t i = 0; i < size; ++i) text[i] = static_cast<char>((i * 2654435761u) >> 13);
  return text;
}

// Tests that liblcm understands what is sent: nothing, a little, the most that one packet holds, and messages
// that take several packets.
TEST(UdpmSocketTest, LcmUnderstandsIt) {
  const std::string url = FreeBusUrl() + "&recv_buf_size=4194304";  // four packets of 64 KB wait at a time
  UdpmSocket socket(ParseUdpmUrl(url));
  Lcm lcm(url);
  for (const size_t size : {0u, 1u, 128u, 65499u - 5u, 65499u - 4u, 65487u, 200'000u}) {
    const std::string data = Text(size);
    ASSERT_TRUE(socket.Send("NAME", data.data(), data.size()));
    const auto [channel, heard] = lcm.Next();
    EXPECT_EQ(channel, "NAME") << size;
    EXPECT_TRUE(heard == data) << size;
  }
}

// Tests that messages of the same sizes from liblcm are understood, with their time of arrival.
TEST(UdpmSocketTest, UnderstandsLcm) {
  const std::string url = FreeBusUrl() + "&recv_buf_size=4194304";  // four packets of 64 KB wait at a time
  UdpmSocket socket(ParseUdpmUrl(url));
  socket.Accept("NAME");
  Lcm lcm(url);
  for (const size_t size : {0u, 1u, 128u, 65499u - 5u, 65499u - 4u, 65487u, 200'000u}) {
    const std::string data = Text(size);
    lcm.Send("NAME", data);
    std::string heard;
    EXPECT_EQ(Next(socket, &heard), "NAME") << size;
    EXPECT_TRUE(heard == data) << size;
  }
}

// Tests that only the requested channels arrive, whatever the length of their names: the kernel compares them
// in pieces of four, two and one bytes.
TEST(UdpmSocketTest, OnlyWhatWasAskedFor) {
  const std::string url = FreeBusUrl();
  UdpmSocket sender(ParseUdpmUrl(url)), receiver(ParseUdpmUrl(url));
  const std::string longest(63, 'L');
  const std::vector<std::string> wanted{"A", "AB", "ABC", "ABCD", "ABCDE", "ABCDEFG", "HYDRO_STATE", longest};
  const std::vector<std::string> unwanted{"B",
                                          "AC",
                                          "ABD",
                                          "ABCE",
                                          "ABCDF",
                                          "ABCDEFH",
                                          "ABCDEF",
                                          "HYDRO_STATE_2",
                                          "HYDRO_STAT",
                                          longest.substr(1),
                                          longest.substr(1) + "M"};
  for (const std::string& channel : wanted) receiver.Accept(channel);
  std::vector<std::string> heard;
  for (const std::string& channel : unwanted) ASSERT_TRUE(sender.Send(channel, "x", 1));
  for (const std::string& channel : wanted) ASSERT_TRUE(sender.Send(channel, "x", 1));
  for (size_t i = 0; i < wanted.size(); ++i) heard.push_back(Next(receiver));
  EXPECT_EQ(heard, wanted);
  receiver.AcceptAll();
  ASSERT_TRUE(sender.Send("ANYTHING", "x", 1));
  EXPECT_EQ(Next(receiver), "ANYTHING");
}

// Tests that what is sent to another group on this port is not heard, though this machine has joined that
// group too, and neither is what is sent to this machine's own address.
TEST(UdpmSocketTest, HearsItsOwnGroupAlone) {
  UdpmUrl url = ParseUdpmUrl(FreeBusUrl());
  UdpmSocket ours(url);
  ours.AcceptAll();
  UdpmUrl other_url = url;
  other_url.group = "239.255.76.99";
  UdpmSocket other(other_url);
  other.AcceptAll();
  ASSERT_TRUE(other.Send("THEIRS", "x", 1));
  EXPECT_EQ(Next(other), "THEIRS");
  const int fd = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in here{};
  here.sin_family = AF_INET;
  here.sin_port = htons(url.port);
  here.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  using namespace std::string_literals;
  const std::string packet = "LC02\0\0\0\0DIRECT\0!"s;
  sendto(fd, packet.data(), packet.size(), 0, reinterpret_cast<sockaddr*>(&here), sizeof here);
  close(fd);
  ASSERT_TRUE(ours.Send("OURS", "x", 1));
  EXPECT_EQ(Next(ours), "OURS");
}

// Tests that packets that are not LCM's, or not whole, are skipped.
TEST(UdpmSocketTest, SkipsWhatIsNotLcm) {
  const std::string url = FreeBusUrl();
  UdpmSocket socket(ParseUdpmUrl(url));
  socket.AcceptAll();
  const int fd = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const UdpmUrl parsed = ParseUdpmUrl(url);
  sockaddr_in group{};
  group.sin_family = AF_INET;
  group.sin_port = htons(parsed.port);
  inet_pton(AF_INET, parsed.group.c_str(), &group.sin_addr);
  const auto send = [&](const std::string& packet) {
    ASSERT_EQ(sendto(fd, packet.data(), packet.size(), 0, reinterpret_cast<sockaddr*>(&group), sizeof group),
              static_cast<ssize_t>(packet.size()));
  };
  using namespace std::string_literals;
  send("");
  send("LC02");
  send("LC02\0\0\0\0no end of the channel"s);
  send("LC02\0\0\0\0"s + std::string(70, 'c') + "\0too long"s);
  send("LC03\0\0\0\1\xff\xff\xff\xff\0\0\0\0\0\0\0\1X\0"s);  // of 4 GB
  send("LC03\0\0\0\1\0\0\0\4\0\0\0\xff\0\0\0\1X\0abcd"s);    // beyond its end
  send("LC03\0\0\0\1\0\0\0\4\0\0\0\0\0\2\0\1abcd"s);         // number 2 of 1
  // These two make liblcm 1.3.1 write outside its buffer: offset plus size wraps in 32 bits.
  send("LC03\0\0\0\1\0\0\x10\0\0\0\0\0\0\0\0\3X\0"s + std::string(32, 'A'));
  send("LC03\0\0\0\1\0\0\x10\0\xff\xff\xff\0\0\1\0\3"s + std::string(512, 'B'));
  send("GET / HTTP/1.1\r\n\r\n");
  send("LC02\0\0\0\0GOOD\0!"s);
  close(fd);
  EXPECT_EQ(Next(socket), "GOOD");
}

// Tests that fragments are assembled in any order, and that a lost fragment loses one message.
TEST(FragmentAssemblyTest, AnyOrder) {
  FragmentAssembly assembly;
  const auto fragment = [](uint8_t sequence, uint8_t number, const std::string& data, uint8_t offset) {
    using namespace std::string_literals;
    std::string packet = "LC03\0\0\0"s + static_cast<char>(sequence) + "\0\0\0\6\0\0\0"s +
                         static_cast<char>(offset) + "\0"s + static_cast<char>(number) + "\0\3"s + data;
    return packet;
  };
  using namespace std::string_literals;
  const auto take = [&](uint64_t sender, const std::string& packet) {
    return assembly.Take(sender, reinterpret_cast<const uint8_t*>(packet.data()), packet.size());
  };
  EXPECT_FALSE(take(1, fragment(1, 2, "ef", 4)));
  EXPECT_FALSE(take(1, fragment(1, 0, "NAME\0ab"s, 0)));
  EXPECT_FALSE(take(2, fragment(1, 1, "xx", 2)));  // of another sender
  EXPECT_FALSE(take(1, fragment(2, 1, "xx", 2)));  // of another message
  EXPECT_FALSE(take(1, fragment(1, 2, "ef", 4)));  // twice
  const auto whole = take(1, fragment(1, 1, "cd", 2));
  ASSERT_TRUE(whole);
  EXPECT_EQ(whole->channel, "NAME");
  EXPECT_EQ(std::string(whole->data.begin(), whole->data.end()), "abcdef");
}

}  // namespace
}  // namespace hydro::bus
