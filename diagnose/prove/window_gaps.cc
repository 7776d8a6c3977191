#include "diagnose/prove/window_gaps.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "base/maths/matrix_functions.h"
#include "base/maths/spread.h"
#include "base/parallel.h"
#include "diagnose/fit/residuals.h"
#include "diagnose/fit/turn.h"
#include "model/terms/state.h"

namespace hydro::diagnose {
namespace {

// A start is corrected in at most this many linear models, each confirmed by at most this many simulations,
// as long as each step reduces the squared gap.
constexpr int kLinearModels = 3, kStartSteps = 2;
constexpr double kStartGain = 0.9;
// Within a linear model, which is nearly free, the start's residual of each signal and each signal's weight
// are updated in turn.
constexpr int kWeighings = 6;
// Two predictions whose gaps differ by less than this part are the same. They are left out if at least
// kFewestThatDiffer others remain.
constexpr double kAlike = 0.005;
constexpr size_t kFewestThatDiffer = 2;

using Eigen::Index;
using Eigen::Map;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// A gap that changes by more than this factor belongs to a window that has diverged, and how far is chance.
constexpr double kMostOfAWindow = 4;
// Squared, in noise units: a prediction that is off by a billion has left the range of the equations, and its
// distance means nothing.
constexpr double kDiverged = 1e18;
// Squared, in noise units: a median below it is the noise.
constexpr double kAtTheNoise = 1.25;

// What the residuals leave of the window.
WindowGap GapFrom(const Residuals& residuals, const RunData& window, const model::StartState& start) {
  WindowGap gap;
  gap.squared.fill(std::numeric_limits<double>::quiet_NaN());
  gap.count = residuals.values.size();
  gap.start = start;
  for (size_t s = 0; s + 1 < residuals.first.size(); ++s) {
    const size_t first = residuals.first[s], count = residuals.first[s + 1] - first;
    if (count == 0) continue;
    const double sum = Map<const VectorXd>(&residuals.values[first], static_cast<Index>(count)).squaredNorm();
    gap.squared[static_cast<size_t>(window.signals[s].channel)] = sum / static_cast<double>(count);
    gap.sum += sum;
  }
  gap.tested = gap.count > 0 && gap.sum < kDiverged * static_cast<double>(gap.count);
  return gap;
}

// How a window's residuals depend on its start, linearly.
class StartFit {
 public:
  StartFit(const RunData& window, std::vector<model::Unknown> starts, const Residuals& at)
      : window_(window), starts_(std::move(starts)), first_(at.first) {
    const auto rows = static_cast<Index>(at.values.size());
    jacobian_ = Map<const MatrixXd>(at.jacobian.data(), rows, static_cast<Index>(starts_.size()));
    for (size_t s = 0; s + 1 < first_.size(); ++s) {
      const MatrixXd part = Rows(jacobian_, s);
      normals_.emplace_back(part.transpose() * part);
    }
  }

  // The best start near `from`, where the residuals are `at`. Signals are weighted by what is left of them,
  // because a start that corrected only the signal with the finest sensor would spoil the others. The first
  // weights are those of the sensors' noise.
  model::StartState Best(const model::StartState& from, const Residuals& at) const {
    const VectorXd residual = Map<const VectorXd>(at.values.data(), static_cast<Index>(at.values.size()));
    std::vector<double> left(normals_.size(), 1);
    VectorXd step;
    for (int k = 0; k < kWeighings; ++k) {
      step = Step(from, residual, left);
      const VectorXd then = residual + jacobian_ * step;
      const std::vector<double> before = left;
      for (size_t s = 0; s < left.size(); ++s) {
        const auto part = then.segment(Row(s), Row(s + 1) - Row(s));
        if (part.size() > 0) left[s] = std::max(1.0, part.squaredNorm() / static_cast<double>(part.size()));
      }
      if (left == before) break;
    }
    model::StartState best = from;
    for (size_t i = 0; i < starts_.size(); ++i) best[starts_[i].index] += step(static_cast<Index>(i));
    return best;
  }

 private:
  Index Row(size_t signal) const { return static_cast<Index>(first_[signal]); }
  MatrixXd Rows(const MatrixXd& of, size_t signal) const {
    return of.middleRows(Row(signal), Row(signal + 1) - Row(signal));
  }

  // Least squares, including prior knowledge of the start.
  VectorXd Step(const model::StartState& from, const VectorXd& residual,
                const std::vector<double>& left) const {
    const auto n = static_cast<Index>(starts_.size());
    MatrixXd information = MatrixXd::Zero(n, n);
    VectorXd gradient = VectorXd::Zero(n);
    for (size_t s = 0; s < left.size(); ++s) {
      const Index rows = Row(s + 1) - Row(s);
      information += normals_[s] / left[s];
      gradient += jacobian_.middleRows(Row(s), rows).transpose() * residual.segment(Row(s), rows) / left[s];
    }
    for (Index i = 0; i < n; ++i) {
      const size_t state = starts_[static_cast<size_t>(i)].index;
      const double weight = std::pow(window_.start_error[state], -2);
      information(i, i) += weight;
      gradient(i) += weight * (from[state] - window_.start[state]);
    }
    return -maths::SolveScaled(information, gradient, 1e-9);
  }

  const RunData& window_;
  std::vector<model::Unknown> starts_;
  std::vector<size_t> first_;
  MatrixXd jacobian_;
  std::vector<MatrixXd> normals_;  // of each signal
};

// Whether the channel's median window is at the noise.
bool IsAtTheNoise(const std::vector<WindowGap>& gaps, size_t channel) {
  std::vector<double> squared;
  for (const WindowGap& gap : gaps) {
    if (gap.tested && !std::isnan(gap.squared[channel])) squared.push_back(gap.squared[channel]);
  }
  // An effect that acts in only a few windows does not show in the median, so the mean has to be small too.
  double sum = 0;
  for (const double one : squared) sum += one;
  return squared.empty() ||
         (maths::Median(squared) < kAtTheNoise && sum < kAtTheNoise * static_cast<double>(squared.size()));
}

}  // namespace

double LogarithmOf(double squared_gap) { return std::log(std::clamp(squared_gap, 1e-3, 1e12)); }

double WindowGap::Typical() const {
  double logarithms = 0, channels = 0;
  for (const double one : squared) {
    if (std::isnan(one)) continue;
    logarithms += LogarithmOf(one);
    channels += 1;
  }
  return channels > 0 ? std::exp(logarithms / channels) : std::numeric_limits<double>::quiet_NaN();
}

namespace {

WindowGap GapFromStart(const model::ModelDescription& model, const RunData& window,
                       const model::StartState& turned) {
  model::StartState from = turned;
  WindowGap best;
  try {
    const std::vector<model::Unknown> starts = StartUnknowns(model, window);
    for (int pass = 0; pass < kLinearModels; ++pass) {
      Residuals at = ResidualsOf(model, window, from, {}, starts);
      const WindowGap here = GapFrom(at, window, from);
      if (pass == 0) best = here;
      if (starts.empty() || !here.tested) return best;
      const StartFit fit(window, starts, at);
      const double before = best.Typical();
      for (int step = 0; step < kStartSteps; ++step) {
        from = fit.Best(from, at);
        at = ResidualsOf(model, window, from);
        const WindowGap corrected = GapFrom(at, window, from);
        if (!corrected.tested || corrected.Typical() >= best.Typical()) break;
        const bool enough = corrected.Typical() > kStartGain * best.Typical();
        best = corrected;
        if (enough) break;
      }
      if (best.Typical() < kAtTheNoise || best.Typical() > kStartGain * before) break;
      from = best.start;
    }
  } catch (const model::ModelError&) {
    // A start that cannot be simulated is no improvement. If there is none that can, the window is not
    // tested.
  }
  return best;
}

// `start` is at the model's turn.
WindowGap GapFromTurn(const model::ModelDescription& model, const RunData& window,
                      const model::StartState& start) {
  WindowGap gap = GapFromStart(model, window, start);
  // Most recordings begin at rest. Where the command acts at once, the first samples of the arm's angle give
  // it a speed that it did not have yet, and oil is stiff: no linear model leads back from there.
  const bool estimated = !window.begins_within && window.Find(model::Channel::kArmSpeed) == nullptr;
  if (!estimated || window.start[model::kArmSpeed] == 0 || !window.start_free[model::kArmSpeed]) return gap;
  if (gap.tested && gap.Typical() <= kAtTheNoise) return gap;
  model::StartState at_rest = start;
  at_rest[model::kArmSpeed] = 0;
  WindowGap other = GapFromStart(model, window, at_rest);
  return other.tested && (!gap.tested || other.Typical() < gap.Typical()) ? other : gap;
}

}  // namespace

WindowGap GapOf(const model::ModelDescription& model, const RunData& window) {
  return GapFromTurn(model, window, AtBestTurn(model, window, window.start));
}

std::vector<WindowGap> GapsOfEach(const model::ModelDescription& model,
                                  const std::vector<const RunData*>& windows, int jobs) {
  std::vector<WindowGap> gaps(windows.size());
  ParallelFor(windows.size(), jobs, [&](size_t w) { gaps[w] = GapOf(model, *windows[w]); });
  return gaps;
}

std::vector<WindowGap> GapsOfWindows(const ModelOfRun& model, const JudgingWindows& windows, int jobs) {
  std::vector<WindowGap> gaps(windows.windows.size());
  ParallelFor(gaps.size(), jobs, [&](size_t w) {
    const model::ModelDescription& its = model(windows.runs[w]);
    const RunData& window = *windows.windows[w];
    gaps[w] = windows.turns == nullptr
                  ? GapOf(its, window)
                  : GapFromTurn(its, window, windows.turns->Turned(w, its, window, window.start));
  });
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
  for (size_t w = 0; w < std::min(before.size(), after.size()); ++w) {
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
  // Windows for which both predict the same have no say: a valve that opens in two windows of twenty is
  // judged by these two.
  const auto alike = [](double fall) { return std::abs(fall) < kAlike; };
  if (static_cast<size_t>(std::ranges::count_if(falls, alike)) + kFewestThatDiffer <= falls.size())
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
  const auto tested = std::ranges::count_if(gaps, [](const WindowGap& gap) { return gap.tested; });
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
