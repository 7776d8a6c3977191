// The URL of an LCM network, read strictly (LCM itself ignores unknown options).
#pragma once

#include <cstdint>
#include <string>

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

}  // namespace hydro::bus
