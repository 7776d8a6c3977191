// Which windows a race begins with, who stays in it, and what comes of those who do not.
#include "diagnose/search/race.h"

#include <gmock/gmock.h>

#include <limits>
#include <string>

#include "diagnose/fit/residuals.h"
#include "diagnose/search/proof.h"
#include "diagnose/search/window_search.h"
#include "model/terms/state.h"
#include "tests/diagnose/small_runs.h"

namespace hydro::diagnose {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::SizeIs;

constexpr double kAny = std::numeric_limits<double>::infinity();

Fitted FitOf(const std::string& parameter, double sum, const std::string& failure = "") {
  Fitted fitted;
  fitted.hypothesis.changes = {{"", {}, parameter}};
  fitted.sum = sum;
  fitted.failure = failure;
  return fitted;
}

// Tests that few windows are all taken, and of many a third, with the last few, which hold the extremes.
TEST(RaceSample, AThirdAndTheExtremes) {
  EXPECT_THAT(RaceSample(6), ElementsAre(0, 1, 2, 3, 4, 5));
  const std::vector<size_t> sample = RaceSample(26);
  EXPECT_LT(sample.size(), 14u);
  for (const size_t place : {0u, 3u, 18u, 21u, 22u, 23u, 24u, 25u}) EXPECT_THAT(sample, Contains(place));
}

// Tests that what failed, what is far behind and what another start of the same change beats do not go on, nor more than four.
TEST(InTheRace, TheBestFew) {
  const std::vector<Fitted> fits = {FitOf("b", 10),   FitOf("J", 29),
                                    FitOf("b", 12),   FitOf("D", 31),
                                    FitOf("b", 10.5), FitOf("T_s", 1, "its simulation fails")};
  EXPECT_THAT(InTheRace(fits, kAny), ElementsAre(true, true, false, false, true, false));
  EXPECT_THAT(InTheRace(fits, 20), ElementsAre(true, false, false, false, true, false));
  std::vector<Fitted> many;
  for (const char* name : {"b", "J", "D", "T_s", "k_1", "beta", "V_ms", "c"}) many.push_back(FitOf(name, 10));
  const std::vector<bool> in = InTheRace(many, kAny);
  EXPECT_EQ(std::count(in.begin(), in.end(), true), 4);
}

// Tests on windows of a pump with twice the friction that the change that explains them leads with a fit to all windows, and
// that one that is left behind has a sum of squares that is comparable.
TEST(Race, LeadersAreFittedToAllWindows) {
  model::ModelDescription truth = testing::Table1With();
  truth.parameters.b *= 2;
  const std::vector<RunData> runs = testing::ClampedPair(truth, 8, 1);
  const SearchWindows windows = WindowsForSearch(PointersTo(runs), truth.parameters);
  ASSERT_GE(windows.fitted.size(), 12u);
  SearchContext context;
  context.given = testing::Table1With();
  const SearchContext on_windows = OnWindows(context, windows.fitted, windows.choosing);
  std::vector<Scanned> pool(2);
  for (size_t i = 0; i < pool.size(); ++i) {
    pool[i].change = {"", {}, i == 0 ? "b" : "p_3"};
    pool[i].start = With({context.given, {}, {}, {}}, pool[i].change, {}, false).front();
  }
  FitOptions options;
  options.most_iterations = 8;
  const RaceResult race = Race(on_windows, pool, MeasuredStarts(windows.fitted), options, {});
  ASSERT_THAT(race.leading, SizeIs(1));
  EXPECT_EQ(race.leading[0].hypothesis.changes[0].parameter, "b");
  EXPECT_EQ(race.leading[0].runs.size(), windows.fitted.size());
  EXPECT_LT(race.leading[0].squared_gap(), 1.2);
  ASSERT_THAT(race.behind, SizeIs(1));
  EXPECT_LT(race.behind[0].runs.size(), windows.fitted.size());
  EXPECT_EQ(race.behind[0].count, race.leading[0].count);
  EXPECT_GT(race.behind[0].sum, 3 * race.leading[0].sum);
  // Nothing comes near a tenth of what the best one leaves.
  const RaceResult barred =
      Race(on_windows, pool, MeasuredStarts(windows.fitted), options, {&race.leading[0], 0.1});
  EXPECT_THAT(barred.leading, SizeIs(0));
  EXPECT_THAT(barred.behind, SizeIs(2));
  // A time limit that strikes after the fits to the sample leaves those.
  SearchContext limited = on_windows;
  int asked = 0;
  limited.time_is_up = [&asked] { return ++asked > 2; };
  const RaceResult ended = Race(limited, pool, MeasuredStarts(windows.fitted), options, {});
  EXPECT_THAT(ended.leading, SizeIs(0));
  EXPECT_THAT(ended.behind, SizeIs(2));
  EXPECT_THAT(ended.failed, SizeIs(0));
}

// Tests that starts which made up for what was missing do not hold a race back: measured ones are taken where those predict better.
TEST(Race, BeginsAtTheBetterStart) {
  model::ModelDescription truth = testing::Table1With();
  truth.parameters.b *= 2;
  const std::vector<RunData> runs = testing::ClampedPair(truth, 8, 1);
  const SearchWindows windows = WindowsForSearch(PointersTo(runs), truth.parameters);
  SearchContext context;
  context.given = testing::Table1With();
  const SearchContext on_windows = OnWindows(context, windows.fitted, windows.choosing);
  Scanned entry;
  entry.change = {"", {}, "b"};
  entry.start = With({truth, {}, {}, {}}, entry.change, {}, false).front();
  std::vector<model::StartState> off = MeasuredStarts(windows.fitted);
  for (model::StartState& start : off) start[model::kMotorSpeed] += 300;
  FitOptions options;
  options.most_iterations = 6;
  const RaceResult race = Race(on_windows, {entry}, off, options, {});
  ASSERT_THAT(race.leading, SizeIs(1));
  EXPECT_LT(race.leading[0].squared_gap(), 1.2);
}

}  // namespace
}  // namespace hydro::diagnose
