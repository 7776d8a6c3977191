#include "diagnose/recording/block_means.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "base/maths/linear_fit.h"
#include "base/maths/spread.h"

namespace hydro::diagnose {
namespace {

constexpr double kBlock = 0.1;  // s: longer than fast motion
constexpr size_t kStepsOfABlock = 4, kFewestToFit = 20, kFewestToCorrelate = 6;
// As a share of the variance: a fit that leaves more says nothing.
constexpr double kLeaves = 0.2;

}  // namespace

double RunBlock::Mean(const runs::MeasuredSignal& signal) const {
  if (!signal.measured()) return runs::kMissing;
  double sum = 0;
  for (size_t i = first; i < last; ++i)
    sum += 0.5 * (signal.values[i] + signal.values[i + 1]) * (run->time[i + 1] - run->time[i]);
  return sum / seconds();
}

double RunBlock::Rate(const runs::MeasuredSignal& signal) const {
  return signal.measured() ? (signal.values[last] - signal.values[first]) / seconds() : runs::kMissing;
}

std::vector<RunBlock> RunBlocksOf(const runs::MeasuredRun& run) {
  std::vector<RunBlock> blocks;
  for (size_t first = 0, i = 0; i < run.samples(); ++i) {
    const double seconds = run.time[i] - run.time[first];
    if (seconds < kBlock * (1 - 1e-9) || i - first < kStepsOfABlock) continue;
    if (seconds < 3 * kBlock || i - first == kStepsOfABlock) blocks.push_back({&run, first, i});
    first = i;
  }
  return blocks;
}

std::optional<FittedBlocks> FitBlocks(std::vector<std::vector<double>> columns,
                                      const std::vector<double>& y) {
  if (y.size() < kFewestToFit) return std::nullopt;
  std::vector<double> scales;
  std::vector<std::vector<double>> used;
  for (std::vector<double>& column : columns) {
    double largest = 0;
    for (const double value : column) largest = std::max(largest, std::abs(value));
    scales.push_back(largest);
    if (largest == 0) continue;
    for (double& value : column) value /= largest;
    used.push_back(std::move(column));
  }
  FittedBlocks fitted;
  try {
    const maths::LinearFit fit = maths::FitLinear(used, y);
    double all = 0;
    for (const double value : y) all += value * value;
    const double left = fit.residual_deviation * fit.residual_deviation * static_cast<double>(y.size());
    if (!(left < kLeaves * all)) return std::nullopt;
    size_t place = 0;
    for (const double scale : scales) {
      std::vector<double> weights(used.size(), 0.0);
      if (scale > 0) weights[place++] = 1 / scale;
      fitted.value.push_back(fit.Value(weights));
      fitted.half.push_back(scale > 0 ? fit.HalfWidth95(weights) : 0);
    }
  } catch (const std::invalid_argument&) {  // at rest, or at one speed
    return std::nullopt;
  }
  return fitted;
}

std::optional<double> CorrelationOfBlocks(const std::vector<double>& x, const std::vector<double>& y,
                                          double least) {
  if (x.size() < kFewestToCorrelate) return std::nullopt;
  const auto n = static_cast<double>(x.size());
  const double x_mean = std::accumulate(x.begin(), x.end(), 0.0) / n;
  double square = 0;
  for (const double one : x) square += (one - x_mean) * (one - x_mean);
  if (!(std::sqrt(square / n) > least)) return std::nullopt;
  return maths::Correlation(x, y);
}

std::string WithHalfWidth(double value, double half) {
  half = std::max(half, 1e-3 * std::abs(value));
  return maths::PlusMinus({value, value - half, value + half});
}

}  // namespace hydro::diagnose
