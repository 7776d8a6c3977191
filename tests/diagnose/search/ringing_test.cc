// The frequencies at which measured pressures ring although the model's do not.
#include "diagnose/search/ringing.h"

#include <gmock/gmock.h>

#include "diagnose/search/window_search.h"
#include "tests/diagnose/small_runs.h"

namespace hydro::diagnose {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

// What the model without a line leaves of runs of `truth`.
std::vector<double> RingingOf(const model::ModelDescription& truth) {
  const std::vector<RunData> runs = testing::ClampedPair(truth, 3, 1);
  const SearchWindows windows = WindowsForSearch(PointersTo(runs), truth.parameters);
  Hypothesis given;
  given.model = testing::Table1With();
  const Fitted fitted = Fit(given, windows.fitted, MeasuredStarts(windows.fitted), {});
  return RingingFrequencies(fitted, windows.fitted, 1);
}

// Tests that a line's wave is found near its frequency. The wave couples to the shaft and to the oil of the clamped arm, so the
// pressures ring up to a third faster than the line alone.
TEST(Ringing, IsSeenInTheResiduals) {
  for (const double frequency : {60.0, 90.0, 120.0}) {
    const std::vector<double> found = RingingOf(testing::Table1With(
        {{"line.wave", {{"frequency", frequency}, {"volume_fraction", 0.2}, {"damping", 0.02}}, {}}}));
    ASSERT_FALSE(found.empty()) << frequency;
    EXPECT_GT(found.front(), 0.95 * frequency);
    EXPECT_LT(found.front(), 1.4 * frequency);
  }
}

// Tests that nothing is seen where only noise is left.
TEST(Ringing, NoneInNoise) { EXPECT_THAT(RingingOf(testing::Table1With()), IsEmpty()); }

}  // namespace
}  // namespace hydro::diagnose
