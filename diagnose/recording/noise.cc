// Estimates the noise of a series from the series itself: the level of the quietest part of its upper
// spectrum, or of its quietest samples.
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <utility>

#include "diagnose/recording/run_data.h"

namespace hydro::diagnose {
namespace {

constexpr int kSegment = 64;  // samples in one spectrum; an event spoils at most these
constexpr int kHop = 32;
constexpr int kFirstBin = kSegment / 4;  // the upper half of the spectrum
constexpr int kBins = kSegment / 2 - kFirstBin;
constexpr int kBands = 8;
// Fourth differences remove smooth motion before its side lobes can count.
constexpr double kDifference[] = {1, -4, 6, -4, 1};
constexpr int kOrder = 4;

// Cells of the spectrogram above kClip times the mean are not noise: chance puts 1 in 55 there.
constexpr double kClip = 4;

// The mean of exponentially distributed powers when some are larger because they are not noise. Leaves out
// those far above the mean and corrects the mean for the omission.
double NoisePower(std::vector<double> powers) {
  const auto quarter = powers.begin() + static_cast<std::ptrdiff_t>(powers.size() / 4);
  std::nth_element(powers.begin(), quarter, powers.end());
  double mean = *quarter / -std::log(0.75);
  const double tail = std::exp(-kClip);
  const double kept_mean = 1 - kClip * tail / (1 - tail);  // of an exponential of mean 1, cut off at kClip
  for (int pass = 0; pass < 30; ++pass) {
    double sum = 0;
    size_t kept = 0;
    for (const double power : powers) {
      if (power > kClip * mean) continue;
      sum += power;
      ++kept;
    }
    const double next = kept == 0 ? 0 : sum / static_cast<double>(kept) / kept_mean;
    if (std::abs(next - mean) <= 1e-6 * mean) return next;
    mean = next;
  }
  return mean;
}

// The standard deviation of the noise in fourth differences of consecutive values, without differences that
// an event made large. Where a motion has a corner every few samples, no band of the spectrum is quiet, but
// most differences are.
double QuietNoise(const std::vector<double>& values) {
  constexpr double kCut = 2.5;  // standard deviations
  std::vector<double> sizes;
  for (size_t i = 0; i + kOrder < values.size(); ++i) {
    double difference = 0;
    for (size_t lag = 0; lag <= kOrder; ++lag) difference += kDifference[lag] * values[i + lag];
    if (!std::isnan(difference)) sizes.push_back(std::abs(difference));
  }
  if (sizes.size() < kSegment) return std::numeric_limits<double>::infinity();
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  double spread = *middle / 0.6745;  // the median magnitude of a normal number
  const double density = std::exp(-kCut * kCut / 2) / std::sqrt(2 * std::numbers::pi);
  const double kept_variance = 1 - 2 * kCut * density / std::erf(kCut / std::numbers::sqrt2);
  for (int pass = 0; pass < 10; ++pass) {
    double sum = 0, kept = 0;
    for (const double size : sizes) {
      if (size > kCut * spread) continue;
      sum += size * size;
      kept += 1;
    }
    spread = kept > 0 ? std::sqrt(sum / kept / kept_variance) : 0;
  }
  double square = 0;
  for (const double weight : kDifference) square += weight * weight;
  return spread / std::sqrt(square);
}

// Windowed cosines and sines of the upper half of the spectrum, one in each row.
Eigen::MatrixXd Basis() {
  Eigen::MatrixXd basis(2 * kBins, kSegment);
  for (int bin = 0; bin < kBins; ++bin) {
    // Halfway between the usual bins, so that the last bin is complex like the others.
    const double frequency = 2 * std::numbers::pi * (kFirstBin + bin + 0.5) / kSegment;
    for (int i = 0; i < kSegment; ++i) {
      const double window = 0.5 - 0.5 * std::cos(2 * std::numbers::pi * (i + 0.5) / kSegment);  // Hann
      basis(2 * bin, i) = window * std::cos(frequency * i);
      basis(2 * bin + 1, i) = window * std::sin(frequency * i);
    }
  }
  return basis;
}

// The power of white noise of unit variance in each bin.
Eigen::VectorXd WhitePower(const Eigen::MatrixXd& basis) {
  Eigen::MatrixXd response = Eigen::MatrixXd::Zero(basis.rows(), kSegment + kOrder);
  for (int lag = 0; lag <= kOrder; ++lag) {
    response.middleCols(lag, kSegment) += kDifference[lag] * basis;
  }
  const Eigen::VectorXd each = response.rowwise().squaredNorm();
  return Eigen::Map<const Eigen::Matrix2Xd>(each.data(), 2, kBins).colwise().sum().transpose();
}

// The first samples of segments whose samples are mostly present, according to `measured`; of all segments
// when there are none.
std::vector<int> Segments(const std::vector<double>& measured) {
  std::vector<int> all, whole;
  for (int first = 0; first + kSegment + kOrder <= static_cast<int>(measured.size()); first += kHop) {
    all.push_back(first);
    const auto from = measured.begin() + first;
    const auto missing =
        std::count_if(from, from + kSegment + kOrder, [](double v) { return std::isnan(v); });
    if (missing <= kSegment / 2) whole.push_back(first);
  }
  return whole.empty() ? all : whole;
}

// The standard deviation of the noise of a series without gaps, estimated from these segments.
double SpectralNoise(const std::vector<double>& values, const std::vector<int>& segments) {
  const int samples = static_cast<int>(values.size());
  if (samples < kSegment + kOrder) return 0;
  Eigen::VectorXd differences(samples - kOrder);
  for (int i = 0; i < samples - kOrder; ++i) {
    differences[i] = 0;
    for (int lag = 0; lag <= kOrder; ++lag) {
      differences[i] += kDifference[lag] * values[static_cast<size_t>(i) + static_cast<size_t>(lag)];
    }
  }
  const Eigen::MatrixXd basis = Basis();
  const Eigen::VectorXd white = WhitePower(basis);
  std::vector<std::vector<double>> powers(kBands);
  for (const int first : segments) {
    const Eigen::VectorXd parts = basis * differences.segment(first, kSegment);
    for (int bin = 0; bin < kBins; ++bin) {
      powers[static_cast<size_t>(bin * kBands / kBins)].push_back(parts.segment<2>(2 * bin).squaredNorm() /
                                                                  white[bin]);
    }
  }

  // Pools bands from the quietest two upwards, until the next one is louder by more than chance allows.
  std::ranges::sort(powers, [](const auto& a, const auto& b) { return NoisePower(a) < NoisePower(b); });
  // Independent powers in a band: half as many over the whole spectrum as there are samples.
  const double used = kHop * static_cast<double>(segments.size());
  const double independent = std::max(2.0, used / (4.0 * kBands));
  std::vector<double> pooled = powers.front();
  for (size_t band = 1; band < powers.size(); ++band) {
    const double chance = std::sqrt((1 + 1 / static_cast<double>(band)) / independent);
    if (band > 1 && NoisePower(powers[band]) > NoisePower(pooled) * (1 + 3.5 * chance)) break;
    pooled.insert(pooled.end(), powers[band].begin(), powers[band].end());
  }
  return std::sqrt(NoisePower(pooled));
}

struct Gap {
  size_t first, last;  // missing: [first, last)
};

std::vector<Gap> Gaps(const std::vector<double>& values) {
  std::vector<Gap> gaps;
  for (size_t i = 0; i < values.size(); ++i) {
    if (!std::isnan(values[i])) continue;
    if (gaps.empty() || gaps.back().last != i) gaps.push_back({i, i});
    gaps.back().last = i + 1;
  }
  return gaps;
}

// The mean of the values on one side of a gap, and where that mean lies.
std::pair<double, double> Beside(const std::vector<double>& values, std::ptrdiff_t from, int step) {
  constexpr int kNeighbours = 2;
  double where = 0, sum = 0;
  int count = 0;
  const auto end = static_cast<std::ptrdiff_t>(values.size());
  for (std::ptrdiff_t i = from; i >= 0 && i < end && count < kNeighbours; i += step) {
    if (std::isnan(values[static_cast<size_t>(i)])) break;
    where += static_cast<double>(i);
    sum += values[static_cast<size_t>(i)];
    ++count;
  }
  return {where / count, sum / count};
}

}  // namespace

double EstimateNoise(const std::vector<double>& all) {
  // A signal that stands in at most every second row has samples of its own: between them nothing is missing.
  constexpr double kOwnSamples = 0.75;
  std::vector<double> values = all;
  const bool sparse = static_cast<double>(CountValid(all)) < kOwnSamples * static_cast<double>(all.size());
  if (sparse) std::erase_if(values, [](double value) { return std::isnan(value); });
  if (values.empty()) return 0;
  const double rounding = EstimateResolution(values) / std::sqrt(12.0);
  std::vector<double> whole = values;
  const std::vector<Gap> gaps = Gaps(values);
  if (!gaps.empty() && gaps.front().first == 0 && gaps.front().last == values.size()) return 0;
  for (const Gap& gap : gaps) {
    std::pair<double, double> before = Beside(values, static_cast<std::ptrdiff_t>(gap.first) - 1, -1);
    std::pair<double, double> after = Beside(values, static_cast<std::ptrdiff_t>(gap.last), +1);
    // Before the first value and after the last one, the nearest value is held.
    if (gap.first == 0) before = {after.first - 1, after.second};
    if (gap.last == values.size()) after = {before.first + 1, before.second};
    const double slope = (after.second - before.second) / (after.first - before.first);
    for (size_t i = gap.first; i < gap.last; ++i) {
      whole[i] = before.second + slope * (static_cast<double>(i) - before.first);
    }
  }
  const std::vector<int> segments = Segments(values);
  double noise = SpectralNoise(whole, segments);
  // The bridges over gaps are quieter than the rest. They get noise as large as the estimate, until the
  // estimate agrees with it.
  for (int pass = 0; pass < 4 && !gaps.empty(); ++pass) {
    std::mt19937_64 random(0x9a5);
    std::normal_distribution<double> normal;
    std::vector<double> filled = whole;
    for (const Gap& gap : gaps) {
      for (size_t i = gap.first; i < gap.last; ++i) filled[i] += noise * normal(random);
    }
    noise = SpectralNoise(filled, segments);
  }
  // Taking the smaller of two estimates would give too small a value by chance, so allow three of the
  // standard deviations that correlated differences have. For a signal slower than the recorder, the motion
  // fills the spectrum, and its quietest samples are trusted as they are.
  const double chance = sparse ? 0 : 3 * std::sqrt(1.5 / static_cast<double>(values.size()));
  const double quiet = QuietNoise(values);
  return std::max(quiet < (1 - chance) * noise ? quiet : noise, rounding);
}

}  // namespace hydro::diagnose
