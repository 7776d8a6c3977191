// The addresses in a configuration: of a stack on LCM, and of a front end
// (serial:/dev/ttyACM0?baud=115200, udp://HOST:PORT or unix:/path).
#pragma once

#include <optional>
#include <string>

namespace hydro::settings {

// Returns an empty text when `url` is udpm://GROUP:PORT with optional ?ttl=N&recv_buf_size=BYTES; otherwise
// returns what is allowed. LCM itself silently misreads malformed addresses.
std::string WhatIsWrongWithBusUrl(const std::string& url);

struct FrontEndUrl {
  enum class Kind { kSerial, kUdp, kUnix };

  Kind kind = Kind::kSerial;
  std::string path;  // kSerial: the device file; kUnix: the socket
  int baud = 0;  // kSerial: bits per second; 0: the port's speed is left as it is, which USB devices ignore
  std::string host;  // kUdp: a name or an address; an IPv6 address without its brackets
  std::string port;  // kUdp: a number from 1 to 65535
};

// Returns an empty text and fills in `out` when `url` is such an address; otherwise returns what is allowed.
std::string WhatIsWrongWithFrontEndUrl(const std::string& url, FrontEndUrl* out);

// The termios constant of a baud rate that Linux lists (B115200); none for any other rate.
std::optional<unsigned> BaudConstant(int baud);

}  // namespace hydro::settings
