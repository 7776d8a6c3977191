// Starting points that predict the runs best as they are.
#include "diagnose/search/predicting_starts.h"

#include <gmock/gmock.h>

#include "tests/diagnose/small_runs.h"

namespace hydro::diagnose {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

// Tests the order, how many are kept, that what predicts far worse than what is there is not, and that each begins where it was
// told.
TEST(PredictingStarts, TheBestFirst) {
  model::ModelDescription truth = testing::Table1With();
  truth.parameters.b *= 2;
  const std::vector<RunData> runs = testing::ClampedPair(truth, 0.6, 1);
  SearchContext context;
  context.runs = PointersTo(runs);
  std::vector<Hypothesis> all(4);
  const double factors[] = {0.5, 1.9, 1, 40};  // of b, 2 in truth
  for (size_t i = 0; i < all.size(); ++i) {
    all[i].model = testing::Table1With();
    all[i].model.parameters.b *= factors[i];
  }
  const std::vector<model::StartState> starts = MeasuredStarts(context.runs);
  const Fitted given = Fit(all[2], context.runs, starts, {});
  const Change b = {"", {}, "b"};
  const std::vector<Scanned> best = PredictingStarts(context, b, all, starts, given, 2, 100);
  ASSERT_THAT(best, SizeIs(2));
  EXPECT_EQ(best[0].start.model.parameters.b, all[1].model.parameters.b);
  EXPECT_EQ(best[1].start.model.parameters.b, all[2].model.parameters.b);
  EXPECT_EQ(best[0].change, b);
  EXPECT_EQ(best[0].run_starts, starts);
  EXPECT_THAT(PredictingStarts(context, b, all, starts, given, 4, 100), SizeIs(3))
      << "friction 40 times as large stays";
  EXPECT_THAT(PredictingStarts(context, b, all, starts, given, 4, 1e-3), IsEmpty());
}

}  // namespace
}  // namespace hydro::diagnose
