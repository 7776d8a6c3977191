// What is kept of what was found, and how it is described.
#include "diagnose/verdict/found.h"

#include <gmock/gmock.h>

#include "tests/diagnose/verdict/made_up.h"
#include "tests/diagnose/verdict/small_search.h"

namespace hydro::testing {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

const diagnose::Change kDrag{"pump.quadratic_drag", {}, ""};

// The search with one more effect in its best explanation.
diagnose::SearchResult WithOneMore(const SmallSearch& small, const diagnose::Change& change) {
  diagnose::SearchResult more = small.search;
  const diagnose::Hypothesis both =
      diagnose::With(small.search.best.fitted.hypothesis, change, small.context.sizes, false).front();
  more.best = diagnose::Explain(small.context, both, diagnose::StartsOf(small.search.best.fitted), {});
  return more;
}

// Tests that an effect of which there may be none is dropped, and what is there is kept without a doubt.
TEST(KeepWhatIsThere, DropsWhatIsNotThere) {
  SmallSearch& small = OfADrag();
  const diagnose::SearchResult more = WithOneMore(small, {"fluid.warming", {}, ""});
  ASSERT_TRUE(more.best.fitted.ok());
  ASSERT_THAT(more.best.changes(), SizeIs(2));
  const diagnose::Kept kept = diagnose::KeepWhatIsThere(small.context, more);
  ASSERT_THAT(kept.search.best.changes(), SizeIs(1));
  EXPECT_TRUE(kept.search.best.changes()[0] == kDrag);
  EXPECT_THAT(kept.doubts, IsEmpty());
}

// Tests that an effect is described with its share, its weight and its interval, and that numbers that no rig
// has are doubts.
TEST(DescribeFound, SharesWeightsAndDoubts) {
  SmallSearch& small = OfADrag();
  diagnose::Kept kept{small.search, {}};
  diagnose::Diagnosis d;
  const std::map<std::string, double> weights = {
      {"pump.quadratic_drag", 0.7}, {"pump.quadratic_drag + valve.relief", 0.2}, {"valve.relief", 0.1}};
  const auto models = diagnose::DescribeFound(small.context, small.search.given, {}, weights, &kept, &d);
  EXPECT_THAT(models, SizeIs(1));
  ASSERT_THAT(d.effects, SizeIs(1));
  EXPECT_NEAR(d.effects[0].weight, 0.9, 1e-12);
  EXPECT_GT(d.effects[0].share, 0.95);
  EXPECT_THAT(kept.doubts, IsEmpty());

  // The same runs with a model that states a fortieth of the viscous friction.
  diagnose::SearchContext context = small.context;
  context.given.parameters.b /= 40;
  diagnose::Hypothesis with_b = kept.search.best.fitted.hypothesis;
  with_b.base.push_back(model::BasePlace("b"));
  kept.search.best = diagnose::Explain(context, with_b, diagnose::StartsOf(small.search.best.fitted), {});
  d = {};
  diagnose::DescribeFound(context, small.search.given, {}, weights, &kept, &d);
  ASSERT_THAT(d.parameters, SizeIs(1));
  EXPECT_TRUE(d.parameters[0].implausible);
  ASSERT_THAT(kept.doubts, SizeIs(1));
  EXPECT_THAT(kept.doubts[0], HasSubstr("b = "));
}

}  // namespace
}  // namespace hydro::testing
