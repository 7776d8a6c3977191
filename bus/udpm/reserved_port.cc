#include "bus/udpm/reserved_port.h"

#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include "bus/bus.h"

namespace hydro::bus {

ReservedPort::ReservedPort() : socket_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  // So that a port on which another process listens to any group does not count as free.
  address.sin_addr.s_addr = htonl(INADDR_ANY);
  socklen_t size = sizeof address;
  auto* const generic = reinterpret_cast<sockaddr*>(&address);
  const int yes = 1, no = 0;  // it receives nothing itself
  if (socket_ < 0 || bind(socket_, generic, size) != 0 || getsockname(socket_, generic, &size) != 0 ||
      setsockopt(socket_, IPPROTO_IP, IP_MULTICAST_ALL, &no, sizeof no) != 0 ||
      setsockopt(socket_, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes) != 0) {
    if (socket_ >= 0) close(socket_);
    throw BusError("no free UDP port on this machine");
  }
  number_ = ntohs(address.sin_port);
}

ReservedPort::~ReservedPort() { close(socket_); }

std::string ReservedPort::Url() const { return "udpm://239.255.76.67:" + std::to_string(number_) + "?ttl=0"; }

}  // namespace hydro::bus
