// The URL of an LCM network, and a port for a private one. The URL is read strictly (LCM itself ignores
// unknown options).
#pragma once

#include <cstdint>
#include <string>

#include "base/descriptor.h"

namespace hydro::bus {

struct UdpmUrl {
  std::string group = "239.255.76.67";  // IPv4 multicast address
  uint16_t port = 7667;
  int ttl = 0;            // time to live; 0: a packet stays on this machine, 1: on the local network
  int recv_buf_size = 0;  // bytes requested for the kernel's receive buffer; 0: not given

  std::string ToString() const;
};

// Reads "udpm://GROUP:PORT?ttl=N&recv_buf_size=N"; group, port and options may be left out. Throws InputError
// naming `text`, what is wrong with it, and an example.
UdpmUrl ParseUdpmUrl(const std::string& text);

// A UDP port of this machine for a private bus, a port that no other socket of this machine uses. As long as
// this object lives, processes that ask for a port get other ones, and a bus, which shares its port, can use
// this one.
class ReservedPort {
 public:
  ReservedPort();  // throws BusError when no port is free

  std::string Url() const;  // the URL of a bus on this machine alone (ttl 0) at that port

 private:
  Descriptor socket_;
  int number_ = 0;
};

}  // namespace hydro::bus
