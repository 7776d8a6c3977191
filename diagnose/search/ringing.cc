#include "diagnose/search/ringing.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

#include "base/parallel.h"
#include "diagnose/fit/residuals.h"
#include "maths/median.h"

namespace hydro::diagnose {

namespace {

constexpr double kLeastPeriods = 8;  // in the shortest run
constexpr double kMostOfRate = 0.4;  // of the rate of the samples
constexpr double kStep = 1.02;       // from one frequency to the next
constexpr size_t kAround = 20;       // frequencies to each side that a peak is compared with
constexpr double kClear = 4;         // times their median
constexpr size_t kMostFrequencies = 3;

// The frequencies looked at.
std::vector<double> Grid(const std::vector<const RunData*>& runs) {
  std::vector<double> grid;
  const double highest = kMostOfRate / SampleInterval(runs);
  for (double f = kLeastPeriods / ShortestDuration(runs); f < highest; f *= kStep) grid.push_back(f);
  return grid;
}

// Adds the spectrum of one signal's residuals to `power`, by a Fourier sum that needs no even sampling, with a Hann window.
void AddSpectrum(const std::vector<double>& time, const std::vector<double>& residual,
                 const std::vector<double>& grid, std::vector<double>* power) {
  const double from = time.front(), length = time.back() - time.front();
  std::vector<double> weighted(time.size());
  double sum = 0, weights = 0, squares = 0;
  for (size_t k = 0; k < time.size(); ++k) {
    weighted[k] = 1 - std::cos(2 * std::numbers::pi * (time[k] - from) / length);
    sum += weighted[k] * residual[k];
    weights += weighted[k];
    squares += weighted[k] * weighted[k];
  }
  for (size_t k = 0; k < time.size(); ++k) weighted[k] *= residual[k] - sum / weights;
  for (size_t f = 0; f < grid.size(); ++f) {
    std::complex<double> at = 0;
    for (size_t k = 0; k < time.size(); ++k) {
      at += weighted[k] * std::polar(1.0, 2 * std::numbers::pi * grid[f] * (time[k] - from));
    }
    (*power)[f] += std::norm(at) / squares;
  }
}

// The spectrum of one run's pressures; zeros where it cannot be simulated.
std::vector<double> SpectrumOf(const Fitted& fitted, size_t r, const RunData& run,
                               const std::vector<double>& grid) {
  std::vector<double> power(grid.size());
  Residuals residuals;
  try {
    residuals = ResidualsOf(fitted.hypothesis.model, run, fitted.runs[r].start);
  } catch (const model::ModelError&) {
    return power;
  }
  for (size_t s = 0; s < run.signals.size(); ++s) {
    const SignalData& signal = run.signals[s];
    if (signal.channel != model::Channel::kP1 && signal.channel != model::Channel::kP2) continue;
    std::vector<double> time;
    for (size_t k = 0; k < run.samples(); ++k) {
      if (!std::isnan(signal.values[k])) time.push_back(run.stimulus.time[k]);
    }
    const std::vector<double> values(
        residuals.values.begin() + static_cast<std::ptrdiff_t>(residuals.first[s]),
        residuals.values.begin() + static_cast<std::ptrdiff_t>(residuals.first[s + 1]));
    if (time.size() > 2) AddSpectrum(time, values, grid, &power);
  }
  return power;
}

// How far the spectrum at `f`, without the slope that steps have, stands out from around it.
double Clearness(const std::vector<double>& level, size_t f) {
  const size_t from = f < kAround ? 0 : f - kAround, to = std::min(level.size(), f + kAround + 1);
  const double around = maths::Median(
      {level.begin() + static_cast<std::ptrdiff_t>(from), level.begin() + static_cast<std::ptrdiff_t>(to)});
  return around > 0 ? level[f] / around : 0;
}

}  // namespace

std::vector<double> RingingFrequencies(const Fitted& fitted, const std::vector<const RunData*>& runs,
                                       int jobs) {
  const std::vector<double> grid = Grid(runs);
  std::vector<std::vector<double>> of_run(runs.size());
  ParallelFor(runs.size(), jobs, [&](size_t r) { of_run[r] = SpectrumOf(fitted, r, *runs[r], grid); });
  std::vector<double> level(grid.size());
  for (size_t f = 0; f < grid.size(); ++f) {
    for (const std::vector<double>& power : of_run) level[f] += power[f] * grid[f] * grid[f];
  }
  std::vector<std::pair<double, double>> peaks;  // minus the clearness, frequency
  for (size_t f = 1; f + 1 < grid.size(); ++f) {
    if (!(level[f] > level[f - 1] && level[f] >= level[f + 1])) continue;
    const double clearness = Clearness(level, f);
    if (clearness > kClear) peaks.emplace_back(-clearness, grid[f]);
  }
  std::sort(peaks.begin(), peaks.end());
  if (peaks.size() > kMostFrequencies) peaks.resize(kMostFrequencies);
  std::vector<double> frequencies;
  frequencies.reserve(peaks.size());
  for (const auto& [minus_clearness, frequency] : peaks) frequencies.push_back(frequency);
  return frequencies;
}

}  // namespace hydro::diagnose
