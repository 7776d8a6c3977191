// LCM's UDP multicast, spoken on the thread that uses it.
//
// liblcm receives on a thread of its own, which hands each message on through a queue and a pipe: two
// wake-ups and some allocations per message. For a loop that answers a message, the wake-up is most of the
// round trip. Here the loop itself waits on the socket, the kernel's buffer is the queue, and nothing is
// allocated.
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

  // What arrives on `channel`, of 1 to 63 bytes, is wanted; before the first call nothing is.
  void Accept(const std::string& channel);
  void AcceptAll();

  // Sends one message, never waiting. False: errno says why not; ENOBUFS where a network is slower than what
  // is sent on it.
  bool Send(std::string_view channel, const void* data, size_t size);

  // A received message; it lies in this object until the next call of Receive().
  struct Message {
    const char* channel = nullptr;
    const uint8_t* data = nullptr;
    size_t size = 0;
    int64_t receive_utime = 0;  // us since 1970-01-01 UTC, by the kernel's stamp
  };

  // The next message that waits, whatever its channel. False: none does. What is not LCM's is skipped.
  // Throws BusError.
  bool Receive(Message* message);

  int fd() const { return receiver_; }  // readable when something waits

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
