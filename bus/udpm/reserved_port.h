// Reserves a UDP port of this machine for a private bus.
#pragma once

#include <string>

namespace hydro::bus {

// A port that no other socket of this machine uses. As long as this object lives, processes that ask for a
// port get other ones, and a bus, which shares its port, can use this one.
class ReservedPort {
 public:
  ReservedPort();  // throws BusError when no port is free
  ~ReservedPort();
  ReservedPort(const ReservedPort&) = delete;
  ReservedPort& operator=(const ReservedPort&) = delete;

  std::string Url() const;  // the URL of a bus on this machine alone (ttl 0) at that port

 private:
  int socket_;
  int number_ = 0;
};

}  // namespace hydro::bus
