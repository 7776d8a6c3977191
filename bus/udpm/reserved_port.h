// A UDP port of this machine for a bus of one's own.
#pragma once

#include <string>

namespace hydro::bus {

// A port that no socket of this machine uses, as long as this object lives: others who ask for one get others, and a bus, which
// shares its port, can use it.
class ReservedPort {
 public:
  ReservedPort();  // throws BusError when none is free
  ~ReservedPort();
  ReservedPort(const ReservedPort&) = delete;
  ReservedPort& operator=(const ReservedPort&) = delete;

  std::string Url() const;  // of a bus on this machine alone (ttl 0) at that port

 private:
  int socket_;
  int number_ = 0;
};

}  // namespace hydro::bus
