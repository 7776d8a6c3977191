#include "bus/udpm/udpm_url.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/input_error.h"

namespace hydro::bus {
namespace {

using testing::HasSubstr;

// Tests that every part of a URL is read, and that omitted parts take LCM's defaults.
TEST(UdpmUrlTest, ReadsEveryPart) {
  const UdpmUrl all = ParseUdpmUrl("udpm://239.1.2.3:7000?ttl=1&recv_buf_size=65536");
  EXPECT_EQ(all.group, "239.1.2.3");
  EXPECT_EQ(all.port, 7000);
  EXPECT_EQ(all.ttl, 1);
  EXPECT_EQ(all.recv_buf_size, 65536);
  const UdpmUrl none = ParseUdpmUrl("udpm://");
  EXPECT_EQ(none.group, "239.255.76.67");
  EXPECT_EQ(none.port, 7667);
  EXPECT_EQ(none.ttl, 0);
  EXPECT_EQ(none.recv_buf_size, 0);
  EXPECT_EQ(ParseUdpmUrl("udpm://:7000").port, 7000);
  EXPECT_EQ(ParseUdpmUrl("udpm://?ttl=2").ttl, 2);
}

// Tests that ToString() gives a URL that reads the same.
TEST(UdpmUrlTest, RoundTrips) {
  for (const char* text :
       {"udpm://239.1.2.3:7000?ttl=1&recv_buf_size=65536", "udpm://239.255.76.67:7667?ttl=0"}) {
    EXPECT_EQ(ParseUdpmUrl(text).ToString(), text);
  }
}

// Tests that a bad URL is refused with one line that holds the URL, what is wrong, and an example.
TEST(UdpmUrlTest, RefusesBadUrls) {
  const std::vector<std::pair<std::string, std::string>> table = {
      {"", "must begin with udpm://"},
      {"239.255.76.67:7667", "must begin with udpm://"},
      {"tcpq://localhost", "must begin with udpm://"},
      {"UDPM://239.255.76.67:7667", "must begin with udpm://"},
      {"udpm://192.168.1.1:7667", "\"192.168.1.1\" is not an IPv4 multicast address"},
      {"udpm://239.255.76:7667", "\"239.255.76\" is not"},
      {"udpm://239.255.76.256:7667", "\"239.255.76.256\" is not"},
      {"udpm://localhost:7667", "\"localhost\" is not"},
      {"udpm://239.255.76.67:", "the port is \"\""},
      {"udpm://239.255.76.67:0", "the port is \"0\" and must be a whole number from 1 to 65535"},
      {"udpm://239.255.76.67:65536", "the port is \"65536\""},
      {"udpm://239.255.76.67:76x", "the port is \"76x\""},
      {"udpm://239.255.76.67:7667/", "the port is \"7667/\""},
      {"udpm://239.255.76.67:7667?ttl=256", "ttl is \"256\" and must be a whole number from 0 to 255"},
      {"udpm://239.255.76.67:7667?ttl=-1", "ttl is \"-1\""},
      {"udpm://239.255.76.67:7667?ttl=", "ttl is \"\""},
      {"udpm://239.255.76.67:7667?ttl", "ttl is \"\""},
      {"udpm://239.255.76.67:7667?tll=1", "unknown option \"tll\" (known: ttl, recv_buf_size)"},
      {"udpm://239.255.76.67:7667?recv_buf_size=99999999999", "recv_buf_size is \"99999999999\""},
      {"udpm://239.255.76.67:7667?ttl=1&&", "unknown option \"\""},
  };
  for (const auto& [url, what] : table) {
    try {
      ParseUdpmUrl(url);
      ADD_FAILURE() << url << " was accepted";
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("\"" + url + "\""));
      EXPECT_THAT(error.what(), HasSubstr(what));
      EXPECT_THAT(error.what(), HasSubstr("udpm://239.255.76.67:7667?ttl=0"));
      EXPECT_THAT(error.what(), testing::Not(HasSubstr("\n")));
    }
  }
}

// Tests that two ports that are held at once differ, and that a bus can use one that is held.
TEST(ReservedPortTest, IsOneOfItsOwnAndCanBeUsed) {
  const ReservedPort first, second;
  EXPECT_NE(first.Url(), second.Url());
  EXPECT_NE(first.Url().find("?ttl=0"), std::string::npos);
}

}  // namespace

}  // namespace hydro::bus
