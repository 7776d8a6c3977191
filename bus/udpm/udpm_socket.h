// LCM's UDP multicast protocol on the caller's thread, for every program that receives.
//
// There are two reasons not to use the receiver of liblcm 1.3.1. Its check of fragments wraps in 32 bits, so
// that two datagrams from anyone make it write outside its buffer. And it receives on a thread of its own and
// passes each message on through a queue and a pipe, which costs two wake-ups and several allocations per
// message. For a loop that answers a message, the wake-up is most of the round trip. Here the loop itself
// waits on the socket, the kernel's buffer is the queue, and nothing is allocated.
#pragma once

#include <netinet/in.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "bus/udpm/lcm_packet.h"
#include "bus/udpm/udpm_url.h"

namespace hydro::bus {

class UdpmSocket {
 public:
  // Opens the sockets that LCM would open for the same URL. Throws BusError.
  explicit UdpmSocket(const UdpmUrl& url);
  ~UdpmSocket();
  UdpmSocket(const UdpmSocket&) = delete;
  UdpmSocket& operator=(const UdpmSocket&) = delete;

  // From now on receives messages on `channel` (1 to 63 bytes); before the first call, it receives none.
  void Accept(const std::string& channel);
  void AcceptAll();
  bool accepts_all() const { return all_; }

  // Sends a message and never waits. When it returns false, errno gives the reason: ENOBUFS when the network
  // is slower than the sender.
  bool Send(std::string_view channel, const void* data, size_t size);

  // A received message, valid until the next call of Receive().
  struct Message {
    const char* channel = nullptr;
    const uint8_t* data = nullptr;
    size_t size = 0;
    int64_t receive_utime = 0;  // us since 1970-01-01 UTC, by the kernel's stamp
  };

  // Takes the next waiting message on any channel; returns false when none waits. Skips packets that are not
  // LCM's. Throws BusError.
  bool Receive(Message* message);

  int fd() const { return receiver_; }  // readable when a packet waits

 private:
  bool SendFragments(std::string_view channel, const uint8_t* data, size_t size);

  int receiver_ = -1;
  sockaddr_in group_{};
  int sender_ = -1;
  uint32_t sequence_ = 0;
  bool all_ = false;
  std::vector<std::string> channels_;
  std::vector<uint8_t> packet_;
  FragmentAssembly assembly_;
  FragmentAssembly::Message assembled_;
};

}  // namespace hydro::bus
