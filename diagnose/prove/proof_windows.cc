#include "diagnose/prove/proof_windows.h"

#include <algorithm>
#include <utility>

#include "base/maths/spread.h"
#include "diagnose/prove/proof_context.h"
#include "diagnose/recording/thinned.h"
#include "diagnose/recording/windows.h"

namespace hydro::diagnose {
namespace {

// Limits of a proof's work. With 20 judging windows, a difference of 10 % shows even if single windows
// scatter by 40 %.
constexpr size_t kMostFitted = 9, kMostTold = 20, kMostNear = 32, kMostFar = 6;
// The number of windows added for each extreme. A valve that opens now and then shows in few windows of a
// long run: one of each extreme tells a fit that it opens, three judge beyond one window's scatter.
constexpr size_t kToFitOfAnExtreme = 1, kToJudgeOfAnExtreme = 3;
constexpr size_t kFewestOfAThinned = 200;
constexpr double kWindowsOfARun = 3;

using WindowPool = std::vector<const RunData*>;

// The windows ordered by the channel, times the sign, largest first; without windows in which it is not
// measured.
WindowPool ByHeight(const WindowPool& pool, model::Channel channel, double sign) {
  std::vector<std::pair<double, const RunData*>> heights;
  for (const RunData* window : pool) {
    const SignalData* signal = window->Find(channel);
    if (signal == nullptr) continue;
    const maths::Range range = maths::RangeOf(signal->values);
    heights.emplace_back(sign > 0 ? -range.high : range.low, window);
  }
  std::ranges::stable_sort(heights, [](const auto& a, const auto& b) { return a.first < b.first; });
  WindowPool sorted;
  for (const auto& [height, window] : heights) sorted.push_back(window);
  return sorted;
}

// At most `most` windows of the pool, evenly spread, and so many of each extreme.
WindowPool Chosen(const WindowPool& pool, size_t most, size_t of_an_extreme) {
  std::vector<bool> taken(pool.size());
  const size_t spread = std::min(most, pool.size());
  for (size_t k = 0; k < spread; ++k) taken[k * pool.size() / spread] = true;
  for (const model::Channel channel :
       {model::Channel::kP1, model::Channel::kP2, model::Channel::kMotorSpeed}) {
    for (const double sign : {1.0, -1.0}) {
      // A side's lowest pressure is mostly that of its valve.
      if (sign < 0 && channel != model::Channel::kMotorSpeed) continue;
      const WindowPool highest = ByHeight(pool, channel, sign);
      for (size_t k = 0; k < std::min(highest.size(), of_an_extreme); ++k) {
        taken[static_cast<size_t>(std::ranges::find(pool, highest[k]) - pool.begin())] = true;
      }
    }
  }
  WindowPool chosen;
  for (size_t i = 0; i < pool.size(); ++i) {
    if (taken[i]) chosen.push_back(pool[i]);
  }
  return chosen;
}

// Every `stride`-th window of `all` from `first` to `last`, beginning with the one at `offset`.
WindowPool PoolOf(const std::vector<RunData>& all, size_t first, size_t last, size_t offset, size_t stride) {
  WindowPool pool;
  for (size_t i = first + offset; i < last; i += stride) pool.push_back(&all[i]);
  return pool;
}

void SetJudging(const std::vector<const RunData*>& predicted, const WindowPool& windows,
                JudgingWindows* judging) {
  judging->windows = windows;
  for (const RunData* window : windows) {
    const auto run =
        std::ranges::find_if(predicted, [&](const RunData* one) { return one->name == window->name; });
    judging->runs.push_back(static_cast<size_t>(run - predicted.begin()));
  }
}

}  // namespace

double NearHorizon(const std::vector<const RunData*>& runs) {
  const double seconds = std::max(kHorizon, kFewestSamplesOfAWindow * SampleInterval(runs));
  const auto longer = std::ranges::count_if(
      runs, [&](const RunData* run) { return run->duration() > kWindowsOfARun * seconds; });
  return 2 * static_cast<size_t>(longer) >= runs.size() ? seconds : SearchHorizon(runs);
}

ProofWindows ProofWindowsOf(const ProofContext& context) {
  const std::vector<const RunData*>& predicted = context.predicted();
  const model::Parameters& given = context.given.parameters;
  std::vector<const RunData*> runs = context.runs;
  runs.insert(runs.end(), context.held_out.begin(), context.held_out.end());
  ProofWindows proof;
  proof.near.seconds = NearHorizon(runs);
  proof.far.seconds = kFarTimes * proof.near.seconds;

  std::vector<RunData> all = WindowsOf(context.runs, proof.near.seconds, given);
  const size_t of_fitted = all.size();
  const auto add = [&](std::vector<RunData> windows) {
    for (RunData& window : windows) all.push_back(std::move(window));
    return all.size();
  };
  const size_t near_end = add(WindowsOf(context.held_out, proof.near.seconds, given));
  const size_t far_end = add(WindowsOf(predicted, proof.far.seconds, given));
  // Each simulation stops at every sample, and samples less than a millisecond apart say the same.
  for (RunData& window : all) Thin(kFewestOfAThinned, &window);
  proof.all = std::make_shared<const std::vector<RunData>>(std::move(all));

  const bool in_turn = context.held_out.empty();
  const std::vector<RunData>& kept = *proof.all;
  proof.fitted = Chosen(PoolOf(kept, 0, of_fitted, 0, in_turn ? 2 : 1), kMostFitted, kToFitOfAnExtreme);
  proof.told = Chosen(PoolOf(kept, 0, of_fitted, 0, in_turn ? 2 : 1), kMostTold, kToFitOfAnExtreme);
  const WindowPool near =
      in_turn ? PoolOf(kept, 0, of_fitted, 1, 2) : PoolOf(kept, of_fitted, near_end, 0, 1);
  SetJudging(predicted, Chosen(near, kMostNear, kToJudgeOfAnExtreme), &proof.near);
  SetJudging(predicted, Chosen(PoolOf(kept, near_end, far_end, 0, 1), kMostFar, kToFitOfAnExtreme),
             &proof.far);
  return proof;
}

}  // namespace hydro::diagnose
