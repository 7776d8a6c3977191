#include "base/copy_words.h"

#include <gtest/gtest.h>

#include <string>

namespace hydro {
namespace {

struct Words {
  double number;
  int64_t whole;
  int8_t first, second;
};

// Tests that a copy is one: of words and parts of words, and of what is more than words.
TEST(CopyWordsTest, CopiesAll) {
  Words to{};
  CopyFresh(&to, Words{0.5, -7, 1, -2});
  EXPECT_EQ(to.number, 0.5);
  EXPECT_EQ(to.whole, -7);
  EXPECT_EQ(to.first, 1);
  EXPECT_EQ(to.second, -2);
  std::string text = "short";
  CopyFresh(&text, std::string(100, 'x'));
  EXPECT_EQ(text, std::string(100, 'x'));
}

}  // namespace
}  // namespace hydro
