#include <gmock/gmock.h>
#include <termios.h>

#include "settings/urls.h"

namespace hydro::settings {
namespace {

using ::testing::HasSubstr;
using Kind = FrontEndUrl::Kind;

// Tests what is read from each kind of address.
TEST(FrontEndUrlTest, TakesEachKind) {
  FrontEndUrl url;
  EXPECT_EQ(WhatIsWrongWithFrontEndUrl("serial:/dev/ttyACM0", &url), "");
  EXPECT_EQ(url.kind, Kind::kSerial);
  EXPECT_EQ(url.path, "/dev/ttyACM0");
  EXPECT_EQ(url.baud, 0);
  EXPECT_EQ(WhatIsWrongWithFrontEndUrl("serial:/dev/serial/by-id/usb-A_B?baud=921600", &url), "");
  EXPECT_EQ(url.path, "/dev/serial/by-id/usb-A_B");
  EXPECT_EQ(url.baud, 921600);
  EXPECT_EQ(WhatIsWrongWithFrontEndUrl("udp://bench-7.local:7770", &url), "");
  EXPECT_EQ(url.kind, Kind::kUdp);
  EXPECT_EQ(url.host, "bench-7.local");
  EXPECT_EQ(url.port, "7770");
  EXPECT_EQ(WhatIsWrongWithFrontEndUrl("udp://[fe80::1%eth0]:1", &url), "");
  EXPECT_EQ(url.host, "fe80::1%eth0");
  EXPECT_EQ(WhatIsWrongWithFrontEndUrl("unix:/run/front_end", &url), "");
  EXPECT_EQ(url.kind, Kind::kUnix);
  EXPECT_EQ(url.path, "/run/front_end");
}

// Tests that each malformed address is refused with what would be allowed.
TEST(FrontEndUrlTest, RefusesOthers) {
  const std::pair<const char*, const char*> table[] = {
      {"", "serial:/dev/NAME?baud=RATE, udp://HOST:PORT or unix:/PATH"},
      {"/dev/ttyACM0", "serial:/dev/NAME"},
      {"tcp://host:1", "udp://HOST:PORT"},
      {"serial:", "the whole path of the port"},
      {"serial:ttyACM0", "the whole path of the port"},
      {"serial:/", "the whole path of the port"},
      {"serial:/dev/ttyS0?", "baud=RATE"},
      {"serial:/dev/ttyS0?baud=", "one of 9600"},
      {"serial:/dev/ttyS0?baud=115201", "115200"},
      {"serial:/dev/ttyS0?baud=-9600", "baud=RATE"},
      {"serial:/dev/ttyS0?baud=9600&stop=2", "baud=RATE"},
      {"serial:/dev/ttyS0?speed=9600", "baud=RATE"},
      {"udp://", "udp://HOST:PORT"},
      {"udp://host", "udp://HOST:PORT"},
      {"udp://:7770", "udp://HOST:PORT"},
      {"udp://host:0", "PORT from 1 to 65535"},
      {"udp://host:65536", "PORT from 1 to 65535"},
      {"udp://host:77x", "PORT from 1 to 65535"},
      {"udp://fe80::1:7770", "udp://HOST:PORT"},
      {"udp://host:1/path", "PORT from 1 to 65535"},
      {"unix:", "the whole path of the socket"},
      {"unix:relative", "the whole path of the socket"},
  };
  FrontEndUrl url;
  for (const auto& [text, allowed] : table) {
    EXPECT_THAT(WhatIsWrongWithFrontEndUrl(text, &url), HasSubstr(allowed)) << text;
  }
  EXPECT_NE(WhatIsWrongWithFrontEndUrl("unix:/" + std::string(107, 'a'), &url), "");
  EXPECT_EQ(WhatIsWrongWithFrontEndUrl("unix:/" + std::string(106, 'a'), &url), "");
  EXPECT_NE(WhatIsWrongWithFrontEndUrl(std::string("unix:/a\0b", 9), &url), "");
}

// Tests that the rates are those that Linux has.
TEST(FrontEndUrlTest, Bauds) {
  EXPECT_EQ(BaudConstant(115200), unsigned{B115200});
  EXPECT_EQ(BaudConstant(4000000), unsigned{B4000000});
  EXPECT_FALSE(BaudConstant(0));
  EXPECT_FALSE(BaudConstant(250000));
}

}  // namespace
}  // namespace hydro::settings
