// LCM's UDP multicast protocol on the caller's thread, for every program that receives.
//
// Two reasons against liblcm 1.3.1's own receiver. Its check of fragments wraps in 32 bits, so that two
// datagrams from anybody make it write outside its buffer. And it receives on a thread of its own and passes
// each message on through a queue and a pipe: two wake-ups and several allocations per message. For a loop
// that answers a message, the wake-up is most of the round trip. Here the loop itself waits on the socket,
// the kernel's buffer is the queue, and nothing is allocated.
#pragma once

#include <netinet/in.h>

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "bus/udpm/fragment_assembly.h"
#include "bus/udpm/udpm_url.h"

namespace hydro::bus {

class UdpmSocket {
 public:
  // Opens what LCM would for the same URL. Throws BusError.
  explicit UdpmSocket(const UdpmUrl& url);
  ~UdpmSocket();
  UdpmSocket(const UdpmSocket&) = delete;
  UdpmSocket& operator=(const UdpmSocket&) = delete;

  // Receives messages on `channel` (1 to 63 bytes) from now on; before the first call, receives none.
  void Accept(const std::string& channel);
  void AcceptAll();
  bool accepts_all() const { return all_; }

  // Sends a message and never waits. On false, errno says why: ENOBUFS when the network is slower than the
  // sender.
  bool Send(std::string_view channel, const void* data, size_t size);

  // A received message, valid until the next call of Receive().
  struct Message {
    const char* channel = nullptr;
    const uint8_t* data = nullptr;
    size_t size = 0;
    int64_t receive_utime = 0;  // us since 1970-01-01 UTC, by the kernel's stamp
  };

  // Takes the next waiting message on any channel; false when none waits. Skips packets that are not LCM's.
  // Throws BusError.
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
