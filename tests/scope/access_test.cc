#include "scope/wire/access.h"

#include <gtest/gtest.h>

namespace hydro::scope {
namespace {

const Access& Server() {
  static const Access access("0123456789abcdef", 8765, {"rig.lab"}, {"https://rig.lab"});
  return access;
}

// Tests that only the names of this machine at this port, and those that are configured, pass as hosts: a
// name that resolves to 127.0.0.1 is not one.
TEST(AccessTest, Hosts) {
  for (const char* host : {"127.0.0.1:8765", "localhost:8765", "LOCALHOST:8765", "[::1]:8765", "rig.lab"}) {
    EXPECT_TRUE(Server().HostAllowed(host)) << host;
  }
  for (const char* host :
       {"", "127.0.0.1", "127.0.0.1:8766", "localhost", "evil.example:8765", "evil.example",
        "127.0.0.1:8765.evil.example", "rig.lab:8765", "127.0.0.1:8765 "}) {
    EXPECT_FALSE(Server().HostAllowed(host)) << host;
  }
}

// Tests that pages of other origins are refused, and so is one without an origin of its own ("null").
TEST(AccessTest, Origins) {
  for (const char* origin : {"", "http://127.0.0.1:8765", "http://localhost:8765", "https://rig.lab"}) {
    EXPECT_TRUE(Server().OriginAllowed(origin)) << origin;
  }
  for (const char* origin : {"null", "http://evil.example", "http://127.0.0.1:8766", "http://127.0.0.1",
                             "https://rig.lab.evil.example", "file://"}) {
    EXPECT_FALSE(Server().OriginAllowed(origin)) << origin;
  }
}

// Tests that the token counts whole, from the header or else from the query.
TEST(AccessTest, Tokens) {
  EXPECT_TRUE(Server().TokenRight("Bearer 0123456789abcdef", ""));
  EXPECT_TRUE(Server().TokenRight("", "0123456789abcdef"));
  for (const char* wrong : {"", "0", "0123456789abcde", "0123456789abcdee", "0123456789abcdef0",
                            "0123456789abcdef0123456789abcdef"}) {
    EXPECT_FALSE(Server().TokenRight("", wrong)) << wrong;
    EXPECT_FALSE(Server().TokenRight(std::string("Bearer ") + wrong, "")) << wrong;
  }
  EXPECT_FALSE(Server().TokenRight("0123456789abcdef", ""));
  EXPECT_FALSE(Server().TokenRight("Basic 0123456789abcdef", "0123456789abcdef"));
}

// Tests that tokens are long and differ.
TEST(AccessTest, FreshTokens) {
  const std::string token = FreshToken();
  EXPECT_EQ(token.size(), 32u);
  EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_NE(token, FreshToken());
}

// Tests that paths and queries are decoded, and the first of a name counts.
TEST(TargetTest, Parses) {
  const auto target = ParseTarget("/api/open?name=my%20run%2B1.lcmlog&token=abc&empty&x=1+2&token=def");
  ASSERT_TRUE(target);
  EXPECT_EQ(target->path, "/api/open");
  EXPECT_EQ(target->query.at("name"), "my run+1.lcmlog");
  EXPECT_EQ(target->query.at("token"), "abc");
  EXPECT_EQ(target->query.at("empty"), "");
  EXPECT_EQ(target->query.at("x"), "1 2");
  EXPECT_EQ(ParseTarget("/")->path, "/");
  EXPECT_EQ(ParseTarget("/%2e%2e/x")->path, "/../x");
}

// Tests that what is no path is refused.
TEST(TargetTest, Refuses) {
  for (const char* target : {"", "x", "http://127.0.0.1/", "*", "/%", "/%4", "/%zz", "/a%00b", "/x?a=%"}) {
    EXPECT_FALSE(ParseTarget(target)) << target;
  }
}

// Tests that a list in a header is taken apart.
TEST(TargetTest, Lists) {
  EXPECT_EQ(ListOf("a, b,c ,,\td"), (std::vector<std::string>{"a", "b", "c", "d"}));
  EXPECT_TRUE(ListOf("").empty());
}

}  // namespace

}  // namespace hydro::scope
