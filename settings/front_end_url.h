// The address of a front end: serial:/dev/ttyACM0?baud=115200, udp://HOST:PORT or unix:/path.
#pragma once

#include <optional>
#include <string>

namespace hydro::settings {

struct FrontEndUrl {
  enum class Kind { kSerial, kUdp, kUnix };

  Kind kind = Kind::kSerial;
  std::string path;  // kSerial: the device file; kUnix: the socket
  int baud = 0;  // kSerial: bits per second; 0: the port's speed is left as it is, which USB devices ignore
  std::string host;  // kUdp: a name or an address; of IPv6 without its brackets
  std::string port;  // kUdp: a number from 1 to 65535
};

// Empty, and `out` filled in, when `url` is one; otherwise what is allowed.
std::string WhatIsWrongWithFrontEndUrl(const std::string& url, FrontEndUrl* out);

// The termios constant of a rate of the list that Linux has (B115200); none for any other.
std::optional<unsigned> BaudConstant(int baud);

}  // namespace hydro::settings
