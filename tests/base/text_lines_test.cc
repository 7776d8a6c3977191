// Tests of text as lines.
#include "base/text_lines.h"

#include <gmock/gmock.h>

namespace hydro {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

// Tests that lines come without their ends, that empty ones between others stay, and that an end at the end
// begins no line.
TEST(TextLines, Splits) {
  EXPECT_THAT(TextLines(""), IsEmpty());
  EXPECT_THAT(TextLines("a"), ElementsAre("a"));
  EXPECT_THAT(TextLines("a\n\n b\n"), ElementsAre("a", "", " b"));
  EXPECT_THAT(TextLines("\n"), ElementsAre(""));
}

// Tests that only blanks at the ends go.
TEST(TextLines, Trims) {
  EXPECT_EQ(Trimmed("\t a  b \r"), "a  b");
  EXPECT_EQ(Trimmed(" \t\r"), "");
  EXPECT_EQ(Trimmed(""), "");
}

}  // namespace
}  // namespace hydro
