// What explains as well as what was found.
#include "diagnose/verdict/rivals.h"

#include <gmock/gmock.h>

#include "tests/diagnose/verdict/made_up.h"

namespace hydro::testing {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

struct Case {
  diagnose::SearchResult search;
  diagnose::Explanation refit = Leaving(60, Freed({"b", "T_s", "J", "beta"}), false);
  diagnose::WindowTrials windows;
  std::map<std::string, double> weights;

  // The lag is found, at this squared gap of windows, which decide; 0: there are none.
  explicit Case(double gap_of_windows) {
    windows.decide = gap_of_windows > 0;
    search.given = Leaving(100, Freed({}), false);
    search.best = Scattered(1.1, 1.2, Freed({}, {kLag}), false);
    search.tried = {search.best};
    windows.runs.assign(10, "square");
    if (windows.decide) windows.tried = {Scattered(gap_of_windows, 1.3, Freed({}, {kLag}))};
    weights = {{"amp.lag", 0.7}};
  }

  std::vector<std::string> Of(const diagnose::Change& change) const {
    std::vector<std::string> labels;
    for (const diagnose::Rival& rival : diagnose::RivalsOf(change, search, refit, windows, weights)) {
      labels.push_back(rival.label);
    }
    return labels;
  }
};

// Tests that what leaves the same gap on whole runs is a rival, whatever its weight, and what leaves more is not.
TEST(RivalsOf, TheSameGapOnWholeRuns) {
  Case one(0);
  one.search.tried.push_back(Scattered(1.12, 1 / 1.2, Freed({}, {kDelay}), false));
  one.search.tried.push_back(Scattered(3, 1 / 1.2, Freed({}, {kRelief}), false));
  EXPECT_THAT(one.Of(kLag), ElementsAre("amp.delay"));
}

// Tests that a comparable weight makes a rival of what was tried on windows only, unless every block says
// otherwise, and a small weight does not.
TEST(RivalsOf, AComparableWeightOnWindows) {
  Case one(30);
  one.windows.tried.push_back(Scattered(33, 1 / 1.3, Freed({}, {kDelay})));
  one.windows.tried.push_back(Scattered(31, 1.3, Freed({}, {kRelief})));  // worse in each block
  one.weights = {{"amp.lag", 0.6}, {"amp.delay", 0.2}, {"valve.relief", 0.2}};
  EXPECT_THAT(one.Of(kLag), ElementsAre("amp.delay"));
  one.windows.tried[1] = Scattered(40, 1 / 1.3, Freed({}, {kDelay}));
  one.weights["amp.delay"] = 0.05;
  EXPECT_THAT(one.Of(kLag), IsEmpty());
}

// Tests that whole runs say nothing of rivals where windows decide.
TEST(RivalsOf, OnlyWindowsCountWhereTheyDecide) {
  Case one(30);
  one.search.tried.push_back(Scattered(1.1, 1 / 1.2, Freed({}, {kDelay}), false));
  one.windows.tried.push_back(Scattered(90, 1.3, Freed({}, {kDelay})));
  EXPECT_THAT(one.Of(kLag), IsEmpty());
}

// Tests that other values are rivals too, of one parameter or of all; the model as given never is.
TEST(RivalsOf, OtherValues) {
  Case one(30);
  one.windows.tried.push_back(Scattered(31, 1 / 1.3, Freed({"b"}, {{"", {}, "b"}})));
  one.windows.tried.push_back(Scattered(32, 1 / 1.3, Freed({"b", "T_s", "J", "beta"})));
  one.windows.tried.push_back(Scattered(33, 1 / 1.3, Freed({})));
  one.weights = {{"amp.lag", 0.4}, {"parameter b", 0.2}, {"parameters", 0.2}, {"as given", 0.2}};
  EXPECT_THAT(one.Of(kLag), ElementsAre("parameter b", "parameters"));
}

// Tests that of two effects found, each has its own rivals.
TEST(RivalsOf, EachEffectHasItsOwn) {
  Case one(30);
  one.search.best = Leaving(1.1, Freed({}, {kLag, kRelief}), false);
  one.windows.tried = {Scattered(30, 1.3, Freed({}, {kLag, kRelief})),
                       Scattered(31, 1 / 1.3, Freed({}, {kDelay, kRelief}))};
  one.weights = {{"amp.lag + valve.relief", 0.5}, {"amp.delay + valve.relief", 0.5}};
  EXPECT_THAT(one.Of(kLag), ElementsAre("amp.delay"));
  EXPECT_THAT(one.Of(kRelief), IsEmpty());
}

}  // namespace
}  // namespace hydro::testing
