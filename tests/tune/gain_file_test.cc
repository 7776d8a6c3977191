#include "tune/gain_file.h"

#include <gtest/gtest.h>

namespace hydro::tune {
namespace {

constexpr char kText[] = R"(# A stack, "c1 = 7" in a comment.
[position]   # eq. (17)
sample_interval_s = 0.005
c1 = 10000.0                  # psi/rad
name = "a # b"   # a string with the sign

[limits]
c1 = 3
)";

// Tests that only the value changes: comments, their column, other sections and other keys stay.
TEST(GainFile, ChangesValuesAndKeepsTheRest) {
  EXPECT_EQ(WithKeys(kText, {{"position.c1", "39258"}, {"position.name", "\"x\""}}),
            R"(# A stack, "c1 = 7" in a comment.
[position]   # eq. (17)
sample_interval_s = 0.005
c1 = 39258                    # psi/rad
name = "x"       # a string with the sign

[limits]
c1 = 3
)");
}

TEST(GainFile, MakesRoomForLongerValues) {
  EXPECT_EQ(WithKeys("[a]\nb = 1 # c\n", {{"a.b", "1234567"}}), "[a]\nb = 1234567 # c\n");
}

TEST(GainFile, AddsKeysAndSections) {
  EXPECT_EQ(WithKeys("[a]\nb = 1\n\n[c]\nd = 2\n", {{"a.e", "true"}, {"f.g", "3"}}),
            "[a]\nb = 1\ne = true\n\n[c]\nd = 2\n\n[f]\ng = 3\n");
  EXPECT_EQ(WithKeys("", {{"a.b", "1"}}), "\n[a]\nb = 1\n");
}

}  // namespace
}  // namespace hydro::tune
