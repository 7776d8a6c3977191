#include "base/word_list.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace hydro {
namespace {

const std::vector<std::string> kNames = {"k_p", "k_v", "natural_frequency_rad_s", "damping_ratio", "rate_hz"};

// Tests that misspelt names, names in the wrong case and names without their unit find the right one.
TEST(DidYouMeanTest, FindsNearNames) {
  EXPECT_EQ(Nearest("kp", kNames), "k_p");
  EXPECT_EQ(Nearest("natural_frequency", kNames), "natural_frequency_rad_s");
  EXPECT_EQ(Nearest("natural_frequncy_rad_s", kNames), "natural_frequency_rad_s");
  EXPECT_EQ(Nearest("Damping_Ratio", kNames), "damping_ratio");
  EXPECT_EQ(DidYouMean("rate_Hz", kNames), ", did you mean \"rate_hz\"?");
}

// Tests that a word for sh is quoted where it has to be, and only there.
TEST(ShellWordTest, QuotesWhatNeedsIt) {
  EXPECT_EQ(ShellWord("/var/log/run-1_a+b.lcmlog"), "/var/log/run-1_a+b.lcmlog");
  EXPECT_EQ(ShellWord("it's a run"), "'it'\\''s a run'");
  EXPECT_EQ(ShellWord("$HOME"), "'$HOME'");
  EXPECT_EQ(ShellWord(""), "''");
}

// Tests that an unrelated word finds nothing.
TEST(DidYouMeanTest, FindsNothingFarAway) {
  EXPECT_EQ(Nearest("colour", kNames), "");
  EXPECT_EQ(Nearest("", kNames), "");
  EXPECT_EQ(Nearest(std::string(100000, 'k'), kNames), "");
  EXPECT_EQ(DidYouMean("x", {}), "");
}

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
