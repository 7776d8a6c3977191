#include "diagnose/prove/window_gaps.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/parallel.h"
#include "diagnose/data/thinned.h"
#include "diagnose/fit/held_out.h"
#include "diagnose/fit/residuals.h"
#include "diagnose/fit/run_cost.h"
#include "diagnose/fit/turn.h"
#include "maths/median.h"
#include "maths/solve.h"

namespace hydro::diagnose {

namespace {

// A start is mended by so many steps of least squares, while each takes a part of the squared gap.
constexpr int kPlainSteps = 2, kStartSteps = 2;
constexpr double kStartGain = 0.9;
// Two predictions whose gaps differ by less than this part are the same; so many others have to be left.
constexpr double kAlike = 0.005;
constexpr size_t kFewestThatDiffer = 2;

using Eigen::MatrixXd;

// Of the gap. Beyond it a window has diverged, and how far is chance.
constexpr double kMostOfAWindow = 4;
// Squared, in noise units: a median below it is the noise.
constexpr double kAtTheNoise = 1.25;

// The start after one Gauss-Newton step; none where the window cannot be simulated.
std::optional<model::StartState> BetterStart(const Hypothesis& held, const RunData& window,
                                             const model::StartState& from) {
  RunCost cost(held, window, from);
  model::StartState start = from;
  if (cost.starts().empty()) return start;
  const auto n = static_cast<Eigen::Index>(cost.starts().size());
  std::vector<double> values;
  for (const model::Unknown& unknown : cost.starts()) values.push_back(from[unknown.index]);
  const MatrixXd* normal = cost.Normal(nullptr, values.data());
  if (normal == nullptr) return std::nullopt;
  MatrixXd information = normal->topLeftCorner(n, n);
  for (Eigen::Index i = 0; i < n; ++i) information(i, i) += 1e-300;
  const Eigen::VectorXd scale = information.diagonal().cwiseSqrt().cwiseInverse();
  MatrixXd scaled = scale.asDiagonal() * information * scale.asDiagonal();
  scaled.diagonal().array() += 1e-9;  // numbers that the window cannot show stay where they are
  const MatrixXd step =
      scale.asDiagonal() * maths::SolveSymmetric(scaled, scale.asDiagonal() * normal->topRightCorner(n, 1));
  for (Eigen::Index i = 0; i < n; ++i) start[cost.starts()[static_cast<size_t>(i)].index] -= step(i, 0);
  return start;
}

// False where it cannot be simulated.
bool SetResiduals(const model::ModelDescription& model, const RunData& window, const model::StartState& start,
                  WindowGap* gap) {
  Residuals residuals;
  try {
    residuals = ResidualsOf(model, window, start);
  } catch (const model::ModelError&) {
    return false;
  }
  gap->squared.fill(std::numeric_limits<double>::quiet_NaN());
  gap->sum = 0;
  gap->count = residuals.values.size();
  gap->start = start;
  for (size_t s = 0; s + 1 < residuals.first.size(); ++s) {
    double sum = 0;
    for (size_t i = residuals.first[s]; i < residuals.first[s + 1]; ++i)
      sum += residuals.values[i] * residuals.values[i];
    const size_t count = residuals.first[s + 1] - residuals.first[s];
    if (count == 0) continue;
    gap->squared[static_cast<size_t>(window.signals[s].channel)] = sum / static_cast<double>(count);
    gap->sum += sum;
  }
  gap->tested = gap->count > 0 && std::isfinite(gap->sum);
  return gap->tested;
}

// Whether the channel's median window is at the noise.
bool IsAtTheNoise(const std::vector<WindowGap>& gaps, size_t channel) {
  std::vector<double> squared;
  for (const WindowGap& gap : gaps) {
    if (gap.tested && !std::isnan(gap.squared[channel])) squared.push_back(gap.squared[channel]);
  }
  // Where an effect acts in few windows only, its median does not show: the mean has to be small too.
  double sum = 0;
  for (const double one : squared) sum += one;
  return squared.empty() ||
         (maths::Median(squared) < kAtTheNoise && sum < kAtTheNoise * static_cast<double>(squared.size()));
}

}  // namespace

double WindowGap::Typical() const {
  double logarithms = 0, channels = 0;
  for (const double one : squared) {
    if (std::isnan(one)) continue;
    logarithms += LogarithmOf(one);
    channels += 1;
  }
  return channels > 0 ? std::exp(logarithms / channels) : std::numeric_limits<double>::quiet_NaN();
}

// The window as a start should be fitted to it: what the model leaves of a channel is not the sensor's noise, and a start that had to
// mend the channel with the finest sensor would spoil the others.
RunData WithWhatIsLeft(const RunData& window, const WindowGap& gap) {
  RunData weighed = ThinnedCopy(window);
  for (SignalData& signal : weighed.signals) {
    const double left = gap.squared[static_cast<size_t>(signal.channel)];
    if (left > 1) signal.noise *= std::sqrt(left);
  }
  return weighed;
}

WindowGap GapOf(const model::ModelDescription& model, const RunData& window) {
  Hypothesis held;
  held.model = model;
  WindowGap best;
  model::StartState from = AtBestTurn(model, window, window.start);
  if (!SetResiduals(model, window, from, &best)) {
    const std::optional<model::StartState> start = BetterStart(held, window, from);
    if (start.has_value()) SetResiduals(model, window, *start, &best);
    return best;
  }
  for (int step = 0; step < kPlainSteps + kStartSteps; ++step) {
    // First as the sensors' noise has it. What that leaves beyond the noise is the model's, and weighs the next step.
    const bool plain = step < kPlainSteps;
    if (!plain && best.sum < kAtTheNoise * kAtTheNoise * static_cast<double>(best.count)) break;
    const std::optional<model::StartState> start =
        BetterStart(held, plain ? ThinnedCopy(window) : WithWhatIsLeft(window, best), from);
    if (!start.has_value() || *start == from) break;
    WindowGap corrected;
    if (!SetResiduals(model, window, *start, &corrected)) break;
    const bool better = plain ? corrected.sum < best.sum : corrected.Typical() < best.Typical();
    if (plain && !better) continue;
    if (!better) break;
    const bool enough = !plain && corrected.Typical() > kStartGain * best.Typical();
    best = corrected;
    from = *start;
    if (enough) break;
  }
  return best;
}

std::vector<WindowGap> GapsOfEach(const model::ModelDescription& model,
                                  const std::vector<const RunData*>& windows, int jobs) {
  std::vector<WindowGap> gaps(windows.size());
  ParallelFor(windows.size(), jobs, [&](size_t w) { gaps[w] = GapOf(model, *windows[w]); });
  return gaps;
}

std::vector<WindowGap> GapsOfWindows(const ModelOfRun& model, const JudgingWindows& windows, int jobs) {
  std::vector<WindowGap> gaps(windows.windows.size());
  ParallelFor(gaps.size(), jobs,
              [&](size_t w) { gaps[w] = GapOf(model(windows.runs[w]), *windows.windows[w]); });
  return gaps;
}

bool GapFall::Exceeds(double part) const {
  return windows > 0 && logarithm >= -std::log1p(-part) && logarithm > error;
}

GapFall FallOf(const std::vector<WindowGap>& before, const std::vector<WindowGap>& after) {
  std::array<bool, model::kChannels> silent{};
  bool all_silent = true;
  for (size_t c = 0; c < model::kChannels; ++c) {
    silent[c] = IsAtTheNoise(before, c) && IsAtTheNoise(after, c);
    all_silent = all_silent && silent[c];
  }
  const double most = std::log(kMostOfAWindow);
  std::vector<double> falls;
  for (size_t w = 0; w < before.size(); ++w) {
    if (!before[w].tested || !after[w].tested) continue;
    double sum = 0, channels = 0;
    for (size_t c = 0; c < model::kChannels; ++c) {
      const double from = before[w].squared[c], to = after[w].squared[c];
      if (std::isnan(from) || std::isnan(to) || (silent[c] && !all_silent)) continue;
      sum += std::clamp(0.5 * (LogarithmOf(from) - LogarithmOf(to)), -most, most);
      channels += 1;
    }
    if (channels > 0) falls.push_back(sum / channels);
  }
  // Where both predict the same, the window has no say: a valve that opens in two windows of twenty is judged by these two.
  const auto alike = [](double fall) { return std::abs(fall) < kAlike; };
  if (static_cast<size_t>(std::count_if(falls.begin(), falls.end(), alike)) + kFewestThatDiffer <=
      falls.size())
    std::erase_if(falls, alike);
  GapFall fall;
  fall.windows = falls.size();
  if (falls.empty()) return fall;
  const auto n = static_cast<double>(falls.size());
  for (const double one : falls) fall.logarithm += one / n;
  double square = 0;
  for (const double one : falls) square += std::pow(one - fall.logarithm, 2);
  fall.error = falls.size() > 1 ? std::sqrt(square / (n * (n - 1))) : 0;
  return fall;
}

bool IsTested(const std::vector<WindowGap>& gaps) {
  const auto tested =
      std::count_if(gaps.begin(), gaps.end(), [](const WindowGap& gap) { return gap.tested; });
  return !gaps.empty() && 2 * static_cast<size_t>(tested) >= gaps.size();
}

double TypicalGap(const std::vector<WindowGap>& gaps) {
  double logarithms = 0, windows = 0;
  for (const WindowGap& gap : gaps) {
    if (!gap.tested) continue;
    logarithms += LogarithmOf(gap.Typical());
    windows += 1;
  }
  return windows > 0 ? std::exp(logarithms / windows) : std::numeric_limits<double>::quiet_NaN();
}

}  // namespace hydro::diagnose
