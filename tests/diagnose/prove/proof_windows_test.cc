// Tests of the windows on which proposals are proved: those that are fitted never judge.
#include "diagnose/prove/proof_windows.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "base/maths/spread.h"
#include "diagnose/prove/proof_context.h"
#include "diagnose/recording/run_data.h"
#include "tests/diagnose/small_runs.h"

namespace hydro::testing {
namespace {

using diagnose::ProofWindows;
using diagnose::RunData;

std::vector<RunData> RunsOf(double seconds) {
  std::vector<RunData> runs;
  for (int which = 0; which < 3; ++which)
    runs.push_back(SmallRun(Table1With(), model::Shaft::kClamped, false, seconds, which, 41));
  return runs;
}

// The first `fitted` runs are fitted, the others held out.
diagnose::ProofContext ContextOf(const std::vector<RunData>& runs, size_t fitted) {
  diagnose::ProofContext context;
  context.given = Table1With();
  for (size_t r = 0; r < runs.size(); ++r) (r < fitted ? context.runs : context.held_out).push_back(&runs[r]);
  context.sizes = diagnose::SizesOf(context.given, context.runs);
  return context;
}

// The first and the last time, s, at which the window is compared: before, its simulation warms up.
struct Stretch {
  double from, to;
};
Stretch ComparedIn(const RunData& window) {
  Stretch compared{1e300, -1e300};
  for (const diagnose::SignalData& signal : window.signals) {
    for (size_t i = 0; i < signal.values.size(); ++i) {
      if (std::isnan(signal.values[i])) continue;
      compared.from = std::min(compared.from, window.stimulus.time[i]);
      compared.to = std::max(compared.to, window.stimulus.time[i]);
    }
  }
  return compared;
}

bool Overlap(const RunData& a, const RunData& b) {
  const Stretch one = ComparedIn(a), other = ComparedIn(b);
  return a.name == b.name && one.from <= other.to && other.from <= one.to;
}

double Highest(const RunData& run, model::Channel channel) {
  return maths::RangeOf(run.Find(channel)->values).high;
}

// Tests that windows of runs that are held out by name judge, each as of its run, and that those of fitted
// runs are fitted.
TEST(ProofWindows, OfHeldOutRuns) {
  const std::vector<RunData> runs = RunsOf(4);
  const diagnose::ProofContext context = ContextOf(runs, 1);
  const ProofWindows windows = ProofWindowsOf(context);
  EXPECT_DOUBLE_EQ(windows.near.seconds, 0.4);
  EXPECT_DOUBLE_EQ(windows.far.seconds, 1.6);
  ASSERT_FALSE(windows.fitted.empty());
  EXPECT_GE(windows.told.size(), windows.fitted.size());
  for (const std::vector<const RunData*>* of_fitted : {&windows.fitted, &windows.told}) {
    for (const RunData* window : *of_fitted) EXPECT_EQ(window->name, runs[0].name);
  }
  for (const diagnose::JudgingWindows* judging : {&windows.near, &windows.far}) {
    ASSERT_EQ(judging->runs.size(), judging->windows.size());
    for (size_t w = 0; w < judging->windows.size(); ++w) {
      EXPECT_EQ(judging->windows[w]->name, context.held_out.at(judging->runs[w])->name);
      const Stretch compared = ComparedIn(*judging->windows[w]);
      EXPECT_NEAR(compared.to - compared.from, judging->seconds, 0.02);
    }
    for (const size_t run : {0, 1}) EXPECT_GT(std::count(judging->runs.begin(), judging->runs.end(), run), 0);
  }
}

// Tests that of runs that are held out in turn, no window that judges is compared where one that is fitted
// is.
TEST(ProofWindows, InTurnTheyDoNotOverlap) {
  const std::vector<RunData> runs = RunsOf(4);
  const ProofWindows windows = ProofWindowsOf(ContextOf(runs, 3));
  EXPECT_GE(windows.fitted.size(), 3u);
  EXPECT_GE(windows.near.windows.size(), 3u);
  for (const RunData* judging : windows.near.windows) {
    for (const RunData* fitted : windows.told) EXPECT_FALSE(Overlap(*judging, *fitted)) << judging->name;
    for (const RunData* fitted : windows.fitted) EXPECT_FALSE(Overlap(*judging, *fitted)) << judging->name;
  }
  for (size_t w = 0; w < windows.near.windows.size(); ++w)
    EXPECT_EQ(windows.near.windows[w]->name, runs.at(windows.near.runs[w]).name);
}

// Tests that the work is bounded however long the runs are, and that the window with the highest pressure is
// among those that judge.
TEST(ProofWindows, BoundedWithTheExtremes) {
  const std::vector<RunData> runs = RunsOf(12);
  const ProofWindows windows = ProofWindowsOf(ContextOf(runs, 1));
  // Those that are spread, and one for each of four extremes.
  EXPECT_LE(windows.fitted.size(), 9u + 4u);
  EXPECT_LE(windows.told.size(), 20u + 4u);
  EXPECT_GE(windows.near.windows.size(), 20u);
  EXPECT_LE(windows.near.windows.size(), 32u + 4u);
  EXPECT_LE(windows.far.windows.size(), 6u + 4u);
  for (const model::Channel channel :
       {model::Channel::kP1, model::Channel::kP2, model::Channel::kMotorSpeed}) {
    double among = 0, all = 0;
    for (const RunData* window : windows.near.windows) among = std::max(among, Highest(*window, channel));
    for (const RunData& window : *windows.all) {
      const bool held_out = window.name != runs[0].name && window.duration() < 1;
      if (held_out) all = std::max(all, Highest(window, channel));
    }
    EXPECT_EQ(among, all);
  }
}

// Tests that windows of short runs are shorter, and that there are no far ones of runs that are shorter than
// these.
TEST(ProofWindows, OfShortRuns) {
  const std::vector<RunData> runs = RunsOf(1);
  const ProofWindows windows = ProofWindowsOf(ContextOf(runs, 2));
  EXPECT_NEAR(windows.near.seconds, 0.25, 0.01);
  EXPECT_EQ(windows.near.seconds, diagnose::SearchHorizon(diagnose::PointersTo(runs)));
  EXPECT_GE(windows.near.windows.size(), 3u);
  const std::vector<RunData> some = RunsOf(1.5);
  const ProofWindows without = ProofWindowsOf(ContextOf(some, 2));
  EXPECT_DOUBLE_EQ(without.near.seconds, 0.4);
  EXPECT_TRUE(without.far.windows.empty());
}

}  // namespace
}  // namespace hydro::testing
