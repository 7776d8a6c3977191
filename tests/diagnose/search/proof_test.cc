#include "diagnose/search/proof.h"

#include <gmock/gmock.h>

#include <cmath>
#include <utility>

#include "diagnose/search/wide_search.h"
#include "diagnose/search/window_search.h"
#include "tests/diagnose/noisy_rig.h"
#include "tests/table1.h"

namespace hydro::diagnose {
namespace {

using ::testing::Contains;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;

class ProofTest : public ::testing::Test {
 protected:
  ProofTest() {
    given_.model = {"Table 1", testing::Table1(), {}};
    model::ModelDescription true_model = given_.model;
    true_model.parameters.b *= 2;
    for (const uint64_t seed : {1, 2}) runs_.push_back(Recorded(true_model, seed));
    context_.given = given_.model;
    context_.runs = {&runs_[0]};
    context_.held_out = {&runs_[1]};
    context_.sizes = SizesOf(given_.model, context_.runs);
    context_.changes = {{"", {}, "b"}, {"", {}, "k_1"}, {"pump.quadratic_drag", {}, ""}};
  }

  // Two seconds at 500 Hz under a square wave with the bypass open.
  static RunData Recorded(const model::ModelDescription& model, uint64_t seed) {
    testing::NoisyRig rig;
    rig.model = model;
    rig.seed = seed;
    rig.step = 2e-3;
    rig.angle_measured = false;
    const double low = -2.0 - 0.1 * static_cast<double>(seed);
    return rig.Record("square", model::Shaft::kClamped, 0, 2, true,
                      [low](double t) { return std::fmod(t, 0.68) < 0.34 ? 2.0 : low; });
  }

  Hypothesis given_;
  std::vector<RunData> runs_;
  SearchContext context_;
};

// Tests that the windows are 0.4 s long, that those fitted are others than those that choose, and that
// only fitted runs are cut.
TEST_F(ProofTest, WindowsOfFittedRuns) {
  EXPECT_NEAR(SearchHorizon(context_.runs), 0.4, 1e-9);
  const SearchWindows windows = WindowsForSearch(context_.runs, given_.model.parameters);
  ASSERT_THAT(windows.fitted, Not(IsEmpty()));
  ASSERT_THAT(windows.choosing, Not(IsEmpty()));
  for (const RunData* fitted : windows.fitted) EXPECT_THAT(windows.choosing, Not(Contains(fitted)));
  const SearchContext on_windows = OnWindows(context_, windows.fitted, windows.choosing);
  EXPECT_TRUE(on_windows.windows);
  EXPECT_EQ(on_windows.runs, windows.fitted);
  EXPECT_EQ(on_windows.held_out, windows.choosing);
}

// Tests that a wrong value is found on windows and proved on a run that was not fitted, that what else leads is
// no better, and that the refit of all values is there to compare.
TEST_F(ProofTest, FindsAWrongValue) {
  const SearchWindows windows = WindowsForSearch(context_.runs, given_.model.parameters);
  const WideSearch near =
      SearchWidely(OnWindows(context_, windows.fitted, windows.choosing), given_, {model::BasePlace("b")});
  const std::vector<const Explanation*> leading = Leading(near.search, 3);
  ASSERT_THAT(leading, Not(IsEmpty()));
  ASSERT_THAT(leading[0]->changes(), SizeIs(1));
  EXPECT_EQ(leading[0]->changes()[0].Label(), "parameter b");
  EXPECT_THAT(Leading(near.search, 1), SizeIs(1));

  const WideSearch proved = SearchAndProve(context_, given_, {model::BasePlace("b")});
  ASSERT_THAT(proved.search.best.changes(), SizeIs(1));
  EXPECT_EQ(proved.search.best.changes()[0].Label(), "parameter b");
  EXPECT_GT(proved.search.given.held_out_gap(), 2);
  EXPECT_LT(proved.search.best.held_out_gap(), 1.2);
  EXPECT_LT(proved.refit.held_out_gap(), 1.2);
}

// Tests that a remark says where the held-out predictions also chose: without runs held out, or with one run fitted.
TEST_F(ProofTest, SaysWhatIsNoProof) {
  EXPECT_THAT(ProofRemark(context_), ::testing::HasSubstr("only one run was fitted"));
  const std::vector<const RunData*> held_out = std::exchange(context_.held_out, {});
  context_.runs.push_back(&runs_[1]);
  EXPECT_THAT(ProofRemark(context_), ::testing::HasSubstr("predicted from the others"));
  context_.held_out = held_out;
  EXPECT_EQ(ProofRemark(context_), "");
}

// An explanation of windows with these changes and this gap.
Explanation OnWindowsOf(const std::vector<Change>& changes, double squared_gap) {
  Explanation one;
  one.windows = true;
  one.fitted.hypothesis.changes = changes;
  one.held_out.gaps = {squared_gap};
  one.blocks.sums = {squared_gap};
  return one;
}

// Tests that what adds to another explanation without a material gain is not tried on whole runs, and what adds with one is.
TEST(Leading, LeavesOutWhatAddsNothing) {
  const Change bias = {"amp.bias", {}, ""}, drag = {"pump.quadratic_drag", {}, ""}, lag = {"amp.lag", {}, ""};
  SearchResult near;
  near.best = OnWindowsOf({bias}, 1.5);
  near.tried = {OnWindowsOf({bias}, 1.5), OnWindowsOf({bias, drag}, 1.45), OnWindowsOf({lag}, 1.6),
                OnWindowsOf({lag, drag}, 1.3)};
  const std::vector<const Explanation*> leading = Leading(near, 5);
  ASSERT_THAT(leading, SizeIs(3));
  EXPECT_EQ(leading[0], &near.best);
  EXPECT_THAT(leading[1]->changes(), ::testing::ElementsAre(lag, drag));
  EXPECT_THAT(leading[2]->changes(), ::testing::ElementsAre(lag));
}

// Tests that a search whose time is up at once ends with the model as given.
TEST_F(ProofTest, EndsWhenTimeIsUp) {
  context_.time_is_up = [] { return true; };
  EXPECT_TRUE(TimeIsUp(context_));
  const WideSearch proved = SearchAndProve(context_, given_, {model::BasePlace("b")});
  EXPECT_THAT(proved.search.best.changes(), IsEmpty());
  EXPECT_TRUE(proved.search.given.fitted.ok());
}

}  // namespace
}  // namespace hydro::diagnose
