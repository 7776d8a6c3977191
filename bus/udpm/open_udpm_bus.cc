#include "bus/udpm/open_udpm_bus.h"

#include <arpa/inet.h>
#include <poll.h>
#include <sys/random.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "base/descriptor.h"
#include "bus/bus.h"
#include "bus/udpm/udpm_url.h"

namespace hydro::bus {
namespace {

constexpr const char* kCure =
    "on one machine `ip route add 224.0.0.0/4 dev lo` (as root) mends it; see docs/troubleshooting.md";
constexpr const char* kFirewallCure = "let the firewall pass 224.0.0.0/4; see docs/troubleshooting.md";

[[noreturn]] void Fail(const UdpmUrl& url, const std::string& what) {
  UdpmUrl shown = url;
  shown.recv_buf_size = 0;  // the user did not write it, and it is not the cause
  throw BusError("multicast does not work for " + shown.ToString() + ": " + what);
}

[[noreturn]] void FailErrno(const UdpmUrl& url, const std::string& what, const std::string& cure) {
  Fail(url, what + ": " + std::strerror(errno) + "; " + cure);
}

template <class Value>
void SetProbeOption(int fd, int level, int option, const Value& value) {
  setsockopt(fd, level, option, &value, sizeof value);
}

// A packet in LCM's format, on the channel of LCM's own self-test so that it surprises no receiver, with
// random bytes by which this process recognises it.
std::vector<uint8_t> MakeProbe() {
  constexpr char kHeader[] = "LC02\0\0\0\0LCM_SELF_TEST";  // magic, sequence number, channel with its final 0
  std::vector<uint8_t> probe(kHeader, kHeader + sizeof kHeader);
  std::array<uint8_t, 16> mark{};
  if (getrandom(mark.data(), mark.size(), 0) < 0) mark[0] = static_cast<uint8_t>(getpid());
  probe.insert(probe.end(), mark.begin(), mark.end());
  return probe;
}

// Sets the sender up to send to the group, and to be heard on this machine too.
void Connect(const Descriptor& sender, const UdpmUrl& url, const sockaddr_in& group) {
  if (connect(sender.number(), reinterpret_cast<const sockaddr*>(&group), sizeof group) != 0) {
    FailErrno(url, "no route to the group", kCure);
  }
  SetProbeOption(sender.number(), IPPROTO_IP, IP_MULTICAST_TTL, static_cast<unsigned char>(url.ttl));
  SetProbeOption(sender.number(), IPPROTO_IP, IP_MULTICAST_LOOP, static_cast<unsigned char>(1));
}

// Joins the group. Returns the size of the receive buffer that the kernel grants.
int Listen(const Descriptor& receiver, const UdpmUrl& url, const sockaddr_in& group) {
  SetProbeOption(receiver.number(), SOL_SOCKET, SO_REUSEADDR, 1);
  if (url.recv_buf_size > 0) SetProbeOption(receiver.number(), SOL_SOCKET, SO_RCVBUF, url.recv_buf_size);
  int receive_buffer = 0;
  socklen_t length = sizeof receive_buffer;
  getsockopt(receiver.number(), SOL_SOCKET, SO_RCVBUF, &receive_buffer, &length);
  if (bind(receiver.number(), reinterpret_cast<const sockaddr*>(&group), sizeof group) != 0) {
    FailErrno(url, "cannot listen on the port", "another program may hold it: choose another port");
  }
  ip_mreq membership{};
  membership.imr_multiaddr = group.sin_addr;
  membership.imr_interface.s_addr = htonl(INADDR_ANY);
  if (setsockopt(receiver.number(), IPPROTO_IP, IP_ADD_MEMBERSHIP, &membership, sizeof membership) != 0) {
    FailErrno(url, "cannot join the group", kCure);
  }
  return receive_buffer;
}

// Waits until `deadline` for a packet that is the probe. Returns false when none came.
bool Receives(const Descriptor& receiver, const std::vector<uint8_t>& probe,
              std::chrono::steady_clock::time_point deadline) {
  std::vector<uint8_t> packet(probe.size() + 1);
  while (true) {
    const auto now = std::chrono::steady_clock::now();
    if (now >= deadline) return false;
    pollfd waiting{receiver.number(), POLLIN, 0};
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - now);
    if (poll(&waiting, 1, static_cast<int>(left.count())) <= 0) continue;
    const ssize_t size = recv(receiver.number(), packet.data(), packet.size(), MSG_DONTWAIT);
    if (size == static_cast<ssize_t>(probe.size()) &&
        std::memcmp(packet.data(), probe.data(), probe.size()) == 0) {
      return true;
    }
  }
}

}  // namespace

int TestMulticast(const UdpmUrl& url, std::chrono::milliseconds timeout) {
  const Descriptor sender(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  const Descriptor receiver(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
  if (sender.number() < 0 || receiver.number() < 0) FailErrno(url, "no socket", "see `ulimit -n`");
  sockaddr_in group{};
  group.sin_family = AF_INET;
  group.sin_port = htons(url.port);
  inet_pton(AF_INET, url.group.c_str(), &group.sin_addr);
  Connect(sender, url, group);
  const int receive_buffer = Listen(receiver, url, group);

  const std::vector<uint8_t> probe = MakeProbe();
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  while (true) {
    // The probe is sent repeatedly, because a busy machine may lose a packet.
    if (send(sender.number(), probe.data(), probe.size(), 0) < 0) {
      FailErrno(url, "cannot send to the group", kFirewallCure);
    }
    const auto next_try = std::chrono::steady_clock::now() + std::chrono::milliseconds(100);
    if (Receives(receiver, probe, std::min(deadline, next_try))) return receive_buffer;
    if (std::chrono::steady_clock::now() >= deadline) {
      Fail(url, "a packet sent to the group did not come back within " + std::to_string(timeout.count()) +
                    " ms; " + kFirewallCure);
    }
  }
}

std::unique_ptr<UdpmBus> OpenUdpmBus(const std::string& url, std::unique_ptr<Authenticator> authenticator) {
  UdpmUrl parsed = ParseUdpmUrl(url);
  if (parsed.recv_buf_size == 0) parsed.recv_buf_size = kReceiveBufferBytes;
  const UdpmBus::ReceiveBuffer buffer{parsed.recv_buf_size, TestMulticast(parsed)};
  return std::make_unique<UdpmBus>(parsed, std::move(authenticator), buffer);
}

}  // namespace hydro::bus
