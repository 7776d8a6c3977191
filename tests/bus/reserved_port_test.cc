#include "bus/udpm/reserved_port.h"

#include <gtest/gtest.h>

namespace hydro::bus {
namespace {

// Tests that two ports that are held at once differ, and that a bus can use one that is held.
TEST(ReservedPortTest, IsOneOfItsOwnAndCanBeUsed) {
  const ReservedPort first, second;
  EXPECT_NE(first.Url(), second.Url());
  EXPECT_NE(first.Url().find("?ttl=0"), std::string::npos);
}

}  // namespace
}  // namespace hydro::bus
