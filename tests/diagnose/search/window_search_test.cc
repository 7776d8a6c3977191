#include "diagnose/search/window_search.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "tests/diagnose/noisy_rig.h"
#include "tests/table1.h"

namespace hydro::diagnose {
namespace {

using ::testing::Contains;
using ::testing::Lt;
using ::testing::Not;
using ::testing::SizeIs;

model::ModelDescription Model() { return {"Table 1", testing::Table1(), {}}; }

// 40 s, of which the search looks at less than half; the pressures are high twice.
RunData LongRun() {
  testing::NoisyRig rig;
  rig.model = Model();
  rig.step = 0.004;
  return rig.Record("two bursts", model::Shaft::kClamped, 0, 40.001, false, [](double t) {
    const bool burst = (t > 11.1 && t < 11.3) || (t > 29.1 && t < 29.3);
    return burst ? 8.0 : std::fmod(t, 0.5) < 0.25 ? 2 : -1.5;
  });
}

double Highest(const RunData& window, model::Channel channel) {
  return RangeOfValues(window.Find(channel)->values).high;
}

// Tests that the windows in which a pressure is highest are looked at, in what is fitted and in what chooses, although
// most windows of a long record are left out: what opens there acts nowhere else.
TEST(WindowSearch, HasTheExtremes) {
  const RunData run = LongRun();
  const SearchWindows windows = WindowsForSearch({&run}, Model().parameters);
  ASSERT_GT(windows.all.size(), 90U);
  EXPECT_THAT(windows.fitted, SizeIs(Lt(30U)));
  EXPECT_THAT(windows.choosing, SizeIs(Lt(30U)));
  for (const model::Channel channel : {model::Channel::kP1, model::Channel::kMotorSpeed}) {
    std::vector<const RunData*> sorted = PointersTo(windows.all);
    std::stable_sort(sorted.begin(), sorted.end(), [channel](const RunData* a, const RunData* b) {
      return Highest(*a, channel) > Highest(*b, channel);
    });
    const auto has_one = [&sorted](const std::vector<const RunData*>& some) {
      return std::count(some.begin(), some.end(), sorted[0]) +
                 std::count(some.begin(), some.end(), sorted[1]) >
             0;
    };
    EXPECT_TRUE(has_one(windows.fitted)) << ChannelName(channel);
    EXPECT_TRUE(has_one(windows.choosing)) << ChannelName(channel);
  }
}

// Tests that no window is both fitted and predicted, and none counts twice.
TEST(WindowSearch, FitsNoneOfThoseThatChoose) {
  const RunData run = LongRun();
  const SearchWindows windows = WindowsForSearch({&run}, Model().parameters);
  const std::set<const RunData*> fitted(windows.fitted.begin(), windows.fitted.end());
  EXPECT_EQ(fitted.size(), windows.fitted.size());
  EXPECT_EQ(std::set<const RunData*>(windows.choosing.begin(), windows.choosing.end()).size(),
            windows.choosing.size());
  for (const RunData* window : windows.choosing) EXPECT_THAT(fitted, Not(Contains(window)));
}

}  // namespace
}  // namespace hydro::diagnose
