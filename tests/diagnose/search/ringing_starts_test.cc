// Resonances at the frequencies at which the runs ring.
#include "diagnose/search/ringing_starts.h"

#include <gmock/gmock.h>

#include "diagnose/search/ringing.h"
#include "diagnose/search/window_search.h"
#include "tests/diagnose/small_runs.h"

namespace hydro::diagnose {
namespace {

using ::testing::IsEmpty;
using ::testing::Lt;

class RingingStartsTest : public ::testing::Test {
 protected:
  RingingStartsTest()
      : runs_(testing::ClampedPair(
            testing::Table1With(
                {{"line.wave", {{"frequency", 60}, {"volume_fraction", 0.3}, {"damping", 0.02}}, {}}}),
            2, 1)),
        windows_(WindowsForSearch(PointersTo(runs_), testing::Table1())) {
    context_.runs = windows_.fitted;
    context_.sizes = SizesOf(testing::Table1With(), context_.runs);
    Hypothesis given;
    given.model = testing::Table1With();
    fitted_ = Fit(given, context_.runs, MeasuredStarts(context_.runs), {});
  }

  std::vector<RunData> runs_;
  SearchWindows windows_;
  SearchContext context_;
  Fitted fitted_;
  Change wave_ = {"line.wave", {}, ""};
};

// Tests that each frequency has starts of its own, near it: what predicts best at first is the weakest resonance.
TEST_F(RingingStartsTest, AreNearEachFrequency) {
  context_.ringing = {200, 72};
  const std::vector<Scanned> starts =
      RingingStarts(context_, fitted_, {{"pump.quadratic_drag", {}, ""}, wave_, {"", {}, "b"}});
  ASSERT_FALSE(starts.empty());
  size_t near_72 = 0;
  for (const Scanned& start : starts) {
    EXPECT_EQ(start.change, wave_);
    const double frequency = start.start.model.effects.at(0).parameters.at("frequency");
    const bool near = frequency > 0.65 * 72 && frequency <= 72;
    EXPECT_TRUE(near || (frequency > 0.65 * 200 && frequency <= 200)) << frequency;
    near_72 += near ? 1 : 0;
  }
  EXPECT_GT(near_72, 0);
  EXPECT_LE(near_72, 2);
}

// Tests that one of them leads to the line's own frequency.
TEST_F(RingingStartsTest, LeadToTheResonance) {
  context_.ringing = RingingFrequencies(fitted_, context_.runs, 1);
  double least = fitted_.sum, frequency = 0;
  for (const Scanned& start : RingingStarts(context_, fitted_, {wave_})) {
    const Fitted fit = Fit(start.start, context_.runs, StartsOf(fitted_), {});
    if (!fit.ok() || fit.sum > least) continue;
    least = fit.sum;
    frequency = fit.hypothesis.Free().front().value;
  }
  EXPECT_THAT(least, Lt(0.2 * fitted_.sum));
  EXPECT_NEAR(frequency, 60, 1);
}

TEST_F(RingingStartsTest, NoneWhereNothingRings) {
  EXPECT_THAT(RingingStarts(context_, fitted_, {wave_}), IsEmpty());
}

}  // namespace
}  // namespace hydro::diagnose
