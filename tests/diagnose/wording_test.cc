// Tests of how numbers and lists are written.
#include <gtest/gtest.h>

#include "base/number_text.h"
#include "base/word_list.h"

namespace hydro::diagnose {
namespace {

// Tests that rounding only touches decimals, and that powers of ten appear only where they are shorter.
TEST(ShortNumber, HasNoPowersOfTenThatNobodyNeeds) {
  EXPECT_EQ(ShortNumber(3.14159), "3.142");
  EXPECT_EQ(ShortNumber(3.14159, 3), "3.14");
  EXPECT_EQ(ShortNumber(3114.2, 3), "3114");
  EXPECT_EQ(ShortNumber(999.7, 3), "1000");
  EXPECT_EQ(ShortNumber(-81000), "-81000");
  EXPECT_EQ(ShortNumber(247004.6), "247005");
  EXPECT_EQ(ShortNumber(2.6e-5), "2.6e-05");
  EXPECT_EQ(ShortNumber(2.5e7), "2.5e+07");
  EXPECT_EQ(ShortNumber(-0.0), "0");
  EXPECT_EQ(ShortNumber(NAN), "-");
}

// Tests commas and the "and" of lists of every length.
TEST(WordList, JoinsAndEnumerates) {
  EXPECT_EQ(Joined({}), "");
  EXPECT_EQ(Joined({"a", "b", "c"}), "a, b, c");
  EXPECT_EQ(Joined({"a", "b"}, "; "), "a; b");
  EXPECT_EQ(Enumerated({}), "");
  EXPECT_EQ(Enumerated({"a"}), "a");
  EXPECT_EQ(Enumerated({"a", "b"}), "a and b");
  EXPECT_EQ(Enumerated({"a", "b", "c"}), "a, b and c");
}

// Tests that a run whose name already says "run" is not called a run twice.
TEST(WordList, NamesRuns) {
  EXPECT_EQ(RunNamed("sine"), "run sine");
  EXPECT_EQ(RunNamed("run 5"), "run 5");
  EXPECT_EQ(RunNamed("runaway"), "run runaway");
  EXPECT_EQ(RunNamed("run5"), "run5");
  EXPECT_EQ(RunNamed("run"), "run run");
  EXPECT_EQ(RunsNamed({"a", "b"}), "runs a and b");
  EXPECT_EQ(RunsNamed({"run 5", "run 6"}), "run 5 and run 6");
  EXPECT_EQ(RunsNamed({"run 5", "b"}), "runs run 5 and b");
}

}  // namespace
}  // namespace hydro::diagnose
