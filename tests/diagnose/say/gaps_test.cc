// Which windows models are compared on.
#include "diagnose/say/gaps.h"

#include <gmock/gmock.h>

namespace hydro::diagnose {
namespace {

std::vector<bool> Tested(const std::vector<WindowGap>& gaps) {
  std::vector<bool> tested;
  for (const WindowGap& gap : gaps) tested.push_back(gap.tested);
  return tested;
}

std::vector<WindowGap> Windows(const std::vector<bool>& tested) {
  std::vector<WindowGap> gaps(tested.size());
  for (size_t w = 0; w < tested.size(); ++w) gaps[w].tested = tested[w];
  return gaps;
}

// Tests that models are compared on windows that all follow, and that one which follows fewer than half keeps
// no other from its own.
TEST(KeepCommon, OnlyWhatAllFollow) {
  GapsByModel gaps;
  gaps[kAsItWas] = Windows({true, false, false, false});
  gaps[kRefitted] = Windows({true, true, true, false});
  gaps[kWithWhatWasFound] = Windows({false, true, true, true});
  KeepCommon(&gaps);
  EXPECT_THAT(Tested(gaps[kAsItWas]), ::testing::Each(false)) << "what it follows are windows at rest";
  EXPECT_THAT(Tested(gaps[kRefitted]), ::testing::ElementsAre(false, true, true, false));
  EXPECT_EQ(Tested(gaps[kWithWhatWasFound]), Tested(gaps[kRefitted]));
}

}  // namespace
}  // namespace hydro::diagnose
