// A UDP port for one test, so that tests that run at the same time do not hear each other.
#pragma once

#include <arpa/inet.h>
#include <sys/socket.h>

#include <stdexcept>
#include <string>

namespace hydro {

// A port that no socket of this machine uses. It stays reserved until this process ends: other callers get
// other ports, while LCM, which shares its ports, can use it.
inline int FreeUdpPort() {
  const int fd = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_ANY);  // so that a port on which any group is heard is not free
  socklen_t length = sizeof address;
  if (fd < 0 || bind(fd, reinterpret_cast<sockaddr*>(&address), length) != 0 ||
      getsockname(fd, reinterpret_cast<sockaddr*>(&address), &length) != 0) {
    throw std::runtime_error("no free UDP port");
  }
  // Set after the port was chosen: the choice avoids every port in use, and from now on LCM may share this
  // one.
  const int reuse = 1, deaf = 0;
  setsockopt(fd, IPPROTO_IP, IP_MULTICAST_ALL, &deaf, sizeof deaf);
  setsockopt(fd, SOL_SOCKET, SO_REUSEADDR, &reuse, sizeof reuse);
  return ntohs(address.sin_port);
}

// The URL of an LCM network on this machine alone, on a port of its own.
inline std::string FreeBusUrl() { return "udpm://239.255.76.67:" + std::to_string(FreeUdpPort()) + "?ttl=0"; }

}  // namespace hydro
