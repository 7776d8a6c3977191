#include "bus/udpm/udpm_socket.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/uio.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include "bus/bus.h"
#include "bus/udpm/lcm_packet.h"

namespace hydro::bus {
namespace {

template <class Value>
bool SetOption(int fd, int level, int option, const Value& value) {
  return setsockopt(fd, level, option, &value, sizeof value) == 0;
}

void Store(uint32_t value, size_t size, uint8_t* bytes) {
  for (size_t i = 0; i < size; ++i) bytes[i] = static_cast<uint8_t>(value >> (8 * (size - 1 - i)));
}

// Names the destination each time: a connected socket keeps its source address and silently drops packets
// while the interface of that address is down.
bool SendAll(int fd, const sockaddr_in& destination, iovec* parts, size_t count) {
  msghdr message{};
  message.msg_name = const_cast<sockaddr_in*>(&destination);
  message.msg_namelen = sizeof destination;
  message.msg_iov = parts;
  message.msg_iovlen = count;
  while (true) {
    if (sendmsg(fd, &message, MSG_DONTWAIT) >= 0) return true;
    if (errno == EAGAIN || errno == EWOULDBLOCK) errno = ENOBUFS;
    if (errno != EINTR) return false;
  }
}

iovec Part(const void* data, size_t size) { return {const_cast<void*>(data), size}; }

}  // namespace

UdpmSocket::UdpmSocket(const UdpmUrl& url) : packet_(kLcmLargestPacket + 1) {
  group_.sin_family = AF_INET;
  group_.sin_port = htons(url.port);
  inet_pton(AF_INET, url.group.c_str(), &group_.sin_addr);
  ip_mreq membership{};
  membership.imr_multiaddr = group_.sin_addr;
  membership.imr_interface.s_addr = htonl(INADDR_ANY);

  sender_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  receiver_ = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const auto address = [](const sockaddr_in& a) { return reinterpret_cast<const sockaddr*>(&a); };
  const bool open = sender_ >= 0 && receiver_ >= 0 &&
                    SetOption(sender_, IPPROTO_IP, IP_MULTICAST_TTL, static_cast<unsigned char>(url.ttl)) &&
                    SetOption(sender_, IPPROTO_IP, IP_MULTICAST_LOOP, static_cast<unsigned char>(1)) &&
                    SetOption(receiver_, SOL_SOCKET, SO_REUSEADDR, 1);
  if (open && url.recv_buf_size > 0) SetOption(receiver_, SOL_SOCKET, SO_RCVBUF, url.recv_buf_size);
  SetOption(receiver_, SOL_SOCKET, SO_TIMESTAMP, 1);
  AttachChannelFilter(receiver_, channels_);
  // The socket is bound to the group, so that packets to other groups on this port, or to this machine alone,
  // do not arrive.
  if (!open || bind(receiver_, address(group_), sizeof group_) != 0 ||
      !SetOption(receiver_, IPPROTO_IP, IP_ADD_MEMBERSHIP, membership)) {
    const std::string why = std::strerror(errno);
    if (sender_ >= 0) close(sender_);
    if (receiver_ >= 0) close(receiver_);
    throw BusError("multicast does not work for " + url.ToString() + ": " + why +
                   "; see docs/troubleshooting.md");
  }
}

UdpmSocket::~UdpmSocket() {
  close(sender_);
  close(receiver_);
}

void UdpmSocket::Accept(const std::string& channel) {
  if (all_ || std::find(channels_.begin(), channels_.end(), channel) != channels_.end()) return;
  channels_.push_back(channel);
  AttachChannelFilter(receiver_, channels_);
}

void UdpmSocket::AcceptAll() {
  all_ = true;
  const int unused = 0;
  setsockopt(receiver_, SOL_SOCKET, SO_DETACH_FILTER, &unused, sizeof unused);
}

bool UdpmSocket::Send(std::string_view channel, const void* data, size_t size) {
  if (channel.size() + 1 + size > kLcmLargestWhole) {
    return SendFragments(channel, static_cast<const uint8_t*>(data), size);
  }
  std::array<uint8_t, kLcmWholeHeader> header;
  Store(kLcmWholeMagic, 4, header.data());
  Store(sequence_++, 4, header.data() + 4);
  std::array<iovec, 4> parts{Part(header.data(), header.size()), Part(channel.data(), channel.size()),
                             Part("", 1), Part(data, size)};
  return SendAll(sender_, group_, parts.data(), parts.size());
}

bool UdpmSocket::SendFragments(std::string_view channel, const uint8_t* data, size_t size) {
  // As in LCM, every fragment but the last has the largest size allowed, and the first also holds the
  // channel.
  const size_t fragments = (channel.size() + 1 + size + kLcmLargestFragment - 1) / kLcmLargestFragment;
  if (fragments > 65535) {
    errno = EMSGSIZE;
    return false;
  }
  const uint32_t sequence = sequence_++;
  size_t offset = 0;
  for (size_t number = 0; number < fragments; ++number) {
    const size_t room = kLcmLargestFragment - (number == 0 ? channel.size() + 1 : 0);
    const size_t piece = std::min(room, size - offset);
    std::array<uint8_t, kLcmFragmentHeader> header;
    Store(kLcmFragmentMagic, 4, header.data());
    Store(sequence, 4, header.data() + 4);
    Store(static_cast<uint32_t>(size), 4, header.data() + 8);
    Store(static_cast<uint32_t>(offset), 4, header.data() + 12);
    Store(static_cast<uint32_t>(number), 2, header.data() + 16);
    Store(static_cast<uint32_t>(fragments), 2, header.data() + 18);
    const bool first = number == 0;
    std::array<iovec, 4> parts{Part(header.data(), header.size()),
                               Part(channel.data(), first ? channel.size() : 0), Part("", first ? 1 : 0),
                               Part(data + offset, piece)};
    if (!SendAll(sender_, group_, parts.data(), parts.size())) return false;
    offset += piece;
  }
  return true;
}

bool UdpmSocket::Receive(Message* message) {
  while (true) {
    sockaddr_in from{};
    iovec part = Part(packet_.data(), packet_.size());
    alignas(cmsghdr) std::array<char, CMSG_SPACE(sizeof(timeval))> control;
    msghdr header{};
    header.msg_name = &from;
    header.msg_namelen = sizeof from;
    header.msg_iov = &part;
    header.msg_iovlen = 1;
    header.msg_control = control.data();
    header.msg_controllen = control.size();
    const ssize_t received = recvmsg(receiver_, &header, MSG_DONTWAIT);
    if (received < 0) {
      if (errno == EAGAIN || errno == EWOULDBLOCK) return false;
      if (errno == EINTR) continue;
      throw BusError(std::string("receiving messages failed: ") + std::strerror(errno));
    }
    message->receive_utime = 0;
    for (cmsghdr* item = CMSG_FIRSTHDR(&header); item != nullptr; item = CMSG_NXTHDR(&header, item)) {
      if (item->cmsg_level == SOL_SOCKET && item->cmsg_type == SCM_TIMESTAMP) {
        timeval stamp;
        std::memcpy(&stamp, CMSG_DATA(item), sizeof stamp);
        message->receive_utime = int64_t{stamp.tv_sec} * 1'000'000 + stamp.tv_usec;
      }
    }
    const auto size = static_cast<size_t>(received);
    if (LcmWhole whole; ReadLcmWhole(packet_.data(), size, &whole)) {
      message->channel = whole.channel;
      message->data = whole.data;
      message->size = whole.size;
      return true;
    }
    const uint64_t sender = uint64_t{from.sin_addr.s_addr} << 16 | from.sin_port;
    if (auto whole = assembly_.Take(sender, packet_.data(), size)) {
      assembled_ = std::move(*whole);
      message->channel = assembled_.channel.c_str();
      message->data = assembled_.data.data();
      message->size = assembled_.data.size();
      return true;
    }
  }
}

}  // namespace hydro::bus
