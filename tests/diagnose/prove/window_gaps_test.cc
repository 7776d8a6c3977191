// Tests of what models leave of single windows; the comparison of such gaps is proved_set_test's.
#include "diagnose/prove/window_gaps.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "diagnose/recording/thinned.h"
#include "diagnose/recording/windows.h"
#include "model/terms/state.h"
#include "tests/diagnose/small_runs.h"

namespace hydro::testing {
namespace {

using diagnose::RunData;
using diagnose::WindowGap;

const std::vector<RunData>& Windows() {
  static const std::vector<RunData> windows = [] {
    static const std::vector<RunData> runs = OneOfEach(Table1With(), 1.2, 51);
    return diagnose::WindowsOf(diagnose::PointersTo(runs), 0.4, Table1());
  }();
  return windows;
}

model::ModelDescription Heavy() {
  model::ModelDescription heavy = Table1With();
  heavy.parameters.J *= 1.5;
  return heavy;
}

// Tests that the typical gap is the geometric mean of the channels that are compared.
TEST(WindowGap, TypicalIsAGeometricMean) {
  WindowGap gap;
  gap.squared.fill(std::numeric_limits<double>::quiet_NaN());
  EXPECT_TRUE(std::isnan(gap.Typical()));
  gap.squared[static_cast<size_t>(model::Channel::kP1)] = 4;
  gap.squared[static_cast<size_t>(model::Channel::kMotorSpeed)] = 9;
  EXPECT_NEAR(gap.Typical(), 6, 1e-12);
}

// Tests that the true model leaves no more than the noise of every window, and another one more. A slow
// angle's steps are less than their noise says.
TEST(WindowGap, TruthLeavesTheNoise) {
  ASSERT_GE(Windows().size(), 8u);
  std::vector<WindowGap> of_truth, of_heavy;
  for (const RunData& window : Windows()) {
    of_truth.push_back(GapOf(Table1With(), window));
    of_heavy.push_back(GapOf(Heavy(), window));
    EXPECT_TRUE(of_truth.back().tested);
    EXPECT_GT(of_truth.back().count, 100u);
    EXPECT_LT(of_truth.back().Typical(), 1.4) << window.name << " at " << window.stimulus.time.front();
    EXPECT_GT(of_truth.back().Typical(), 0.3) << window.name << " at " << window.stimulus.time.front();
  }
  EXPECT_TRUE(IsTested(of_truth));
  EXPECT_NEAR(diagnose::TypicalGap(of_truth), 0.9, 0.2);
  EXPECT_GT(diagnose::TypicalGap(of_heavy), 4);
  EXPECT_TRUE(diagnose::FallOf(of_heavy, of_truth).Exceeds(0.5));
}

// Tests that only channels that were measured are compared, and that the sum is over all of them.
TEST(WindowGap, OfMeasuredChannels) {
  const RunData& window = Windows().front();
  const WindowGap gap = GapOf(Table1With(), window);
  double sum = 0;
  for (size_t c = 0; c < model::kChannels; ++c) {
    const diagnose::SignalData* signal = window.Find(static_cast<model::Channel>(c));
    EXPECT_EQ(std::isnan(gap.squared[c]), signal == nullptr) << c;
    if (signal != nullptr) sum += gap.squared[c] * static_cast<double>(signal->valid);
  }
  EXPECT_NEAR(gap.sum, sum, 1e-6 * sum);
}

// Tests that a start that was measured badly is corrected.
TEST(WindowGap, StartIsCorrected) {
  for (size_t w = 1; w < 3; ++w) {
    RunData window = diagnose::ThinnedCopy(Windows()[w]);
    const double right = window.start[model::kP1];
    window.start[model::kP1] += 40;
    window.start_error[model::kP1] = 40;
    const WindowGap gap = GapOf(Table1With(), window);
    EXPECT_LT(gap.Typical(), 1.5);
    EXPECT_NEAR(gap.start[model::kP1], right, 5);
  }
}

// Tests that a run that begins at rest is followed from there, where the arm's angle, the only sensor of its
// motion, gave it a speed that no correction leads back from.
TEST(WindowGap, ARunMayBeginAtRest) {
  size_t free = 0;
  for (const RunData& one : Windows()) {
    if (one.begins_within || one.stimulus.shaft != model::Shaft::kFree) continue;
    if (one.Find(model::Channel::kArmSpeed) != nullptr) continue;
    ++free;
    RunData window = diagnose::ThinnedCopy(one);
    window.start[model::kArmSpeed] = 40;
    window.start_error[model::kArmSpeed] = 0.01;
    EXPECT_LT(GapOf(Table1With(), window).Typical(), 1.5) << window.name;
  }
  EXPECT_GE(free, 1u);
}

// Tests that an impossible model is not tested, and says nothing.
TEST(WindowGap, ImpossibleIsNotTested) {
  const model::ModelDescription impossible = Table1With({{"amp.bias", {{"bias", std::nan("")}}, {}}});
  const WindowGap gap = GapOf(impossible, Windows().front());
  EXPECT_FALSE(gap.tested);
  EXPECT_FALSE(diagnose::IsTested({gap}));
  EXPECT_FALSE(diagnose::IsTested({}));
  EXPECT_TRUE(std::isnan(diagnose::TypicalGap({gap})));
  EXPECT_EQ(diagnose::FallOf({gap}, {GapOf(Table1With(), Windows().front())}).windows, 0u);
}

// Tests that each window is predicted by the model of its run, with the same bits on one job and on two.
TEST(WindowGap, ModelOfTheRun) {
  const model::ModelDescription truth = Table1With(), heavy = Heavy();
  const diagnose::JudgingWindows judging{0.4, {&Windows()[0], &Windows()[1], &Windows()[3]}, {0, 0, 1}};
  const auto model = [&](size_t run) -> const model::ModelDescription& { return run == 0 ? truth : heavy; };
  const std::vector<WindowGap> gaps = GapsOfWindows(model, judging, 1),
                               again = GapsOfWindows(model, judging, 2);
  ASSERT_EQ(gaps.size(), 3u);
  for (size_t w = 0; w < gaps.size(); ++w) {
    EXPECT_EQ(gaps[w].sum, GapOf(w < 2 ? truth : heavy, *judging.windows[w]).sum);
    EXPECT_EQ(gaps[w].sum, again[w].sum);
    EXPECT_EQ(gaps[w].start, again[w].start);
  }
}

}  // namespace
}  // namespace hydro::testing
