#include <gtest/gtest.h>

#include "settings/urls.h"

namespace hydro::settings {
namespace {

// Tests that LCM's multicast addresses are accepted.
TEST(BusUrlTest, TakesMulticastAddresses) {
  for (const char* url : {"udpm://239.255.76.67:7667", "udpm://239.255.76.67:7667?ttl=0",
                          "udpm://224.0.0.1:1", "udpm://239.255.76.67:65535?ttl=255&recv_buf_size=2097152"}) {
    EXPECT_EQ(WhatIsWrongWithBusUrl(url), "") << url;
  }
}

// Tests that everything else is refused with an example of what is allowed.
TEST(BusUrlTest, RefusesOthers) {
  for (const char* url : {"",
                          "udpm",
                          "udpm://",
                          "udpm:///",
                          "tcpq://localhost:7700",
                          "udpm://239.255.76.67",
                          "udpm://239.255.76.67:",
                          "udpm://239.255.76.67:0",
                          "udpm://239.255.76.67:65536",
                          "udpm://239.255.76.67:x",
                          "udpm://239.255.76:7667",
                          "udpm://239.255.76.67.1:7667",
                          "udpm://192.168.0.1:7667",
                          "udpm://239.255.76.256:7667",
                          "udpm://239.255.76.67:7667?",
                          "udpm://239.255.76.67:7667?ttl",
                          "udpm://239.255.76.67:7667?ttl=",
                          "udpm://239.255.76.67:7667?ttl=-1",
                          "udpm://239.255.76.67:7667?ttl=256",
                          "udpm://239.255.76.67:7667?tt=1",
                          "udpm://239.255.76.67:-7667",
                          "udpm://239..76.67:7667",
                          " udpm://239.255.76.67:7667"}) {
    EXPECT_NE(WhatIsWrongWithBusUrl(url).find("udpm://239.255.76.67:7667?ttl=0"), std::string::npos) << url;
  }
}

}  // namespace
}  // namespace hydro::settings
