#include "scope/wire/target.h"

#include <gtest/gtest.h>

namespace hydro::scope {
namespace {

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
