#include "diagnose/fit/comparison.h"

#include <algorithm>
#include <boost/math/distributions/chi_squared.hpp>
#include <cmath>

#include "diagnose/fit/residuals.h"

namespace hydro::diagnose {

namespace {

constexpr size_t kBlocksPerRun = 10;

}  // namespace

BlockSums BlocksOf(const std::vector<const RunData*>& runs, const HeldOut& predicted) {
  BlockSums blocks;
  for (size_t r = 0; r < runs.size(); ++r) {
    std::vector<double> sums(kBlocksPerRun, 0.0);
    Residuals residuals;
    try {
      residuals = ResidualsOf(predicted.models[r], *runs[r], predicted.starts[r]);
    } catch (const model::ModelError&) {
      // As bad as infinity, but comparable.
      blocks.sums.insert(blocks.sums.end(), kBlocksPerRun, 1e12);
      continue;
    }
    for (size_t s = 0; s + 1 < residuals.first.size(); ++s) {
      const size_t n = residuals.first[s + 1] - residuals.first[s];
      for (size_t i = 0; i < n; ++i) {
        const double value = residuals.values[residuals.first[s] + i];
        sums[i * kBlocksPerRun / n] += value * value;
      }
      blocks.count += static_cast<double>(n);
    }
    blocks.sums.insert(blocks.sums.end(), sums.begin(), sums.end());
  }
  return blocks;
}

BlockSums LogarithmsOf(const HeldOut& predicted) {
  BlockSums blocks;
  for (const double gap : predicted.gaps) blocks.sums.push_back(LogarithmOf(gap));
  blocks.count = static_cast<double>(predicted.count);
  return blocks;
}

double TValue(const BlockSums& worse, const BlockSums& better) {
  const size_t n = worse.sums.size();
  double mean = 0;
  for (size_t i = 0; i < n; ++i) mean += (worse.sums[i] - better.sums[i]) / static_cast<double>(n);
  double square = 0;
  for (size_t i = 0; i < n; ++i) square += std::pow(worse.sums[i] - better.sums[i] - mean, 2);
  const double error = std::sqrt(square / static_cast<double>(n * (n - 1)));
  return error > 0 ? mean / error : 0;
}

double LeastMaterialGain(double squared_gap_before) {
  return std::max(kLeastGain, kLeastShare * (squared_gap_before - 1));
}

bool Material(double squared_gap_before, double squared_gap_after) {
  return squared_gap_before - squared_gap_after >= LeastMaterialGain(squared_gap_before);
}

bool Closed(double squared_gap_before, double squared_gap_after, bool exact_sensors) {
  constexpr double kClosed = 1.15, kClosedShare = 0.01;
  if (squared_gap_after <= kClosed * kClosed) return true;
  return exact_sensors && squared_gap_after - 1 <= kClosedShare * (squared_gap_before - 1);
}

bool ExactSensors(const std::vector<const RunData*>& runs) {
  constexpr double kExact = 2e-4;
  for (const RunData* run : runs) {
    for (const SignalData& signal : run->signals) {
      const double size = RangeOfValues(signal.values).size();
      if (size > 0 && signal.noise > kExact * size) return false;
    }
  }
  return true;
}

double PValue(double fall, double squared_gap, double correlation, size_t parameters, size_t tried) {
  if (!(fall > 0)) return 1;
  const boost::math::chi_squared distribution(static_cast<double>(std::max<size_t>(parameters, 1)));
  const double statistic = fall / (std::max(1.0, squared_gap) * correlation);
  const double p = boost::math::cdf(boost::math::complement(distribution, statistic));
  return std::min(1.0, p * static_cast<double>(tried));
}

double CorrelationOf(const std::vector<const RunData*>& runs, const Fitted& fitted) {
  double weighted = 0;
  double count = 0;
  for (size_t r = 0; r < runs.size(); ++r) {
    Residuals residuals;
    try {
      residuals = ResidualsOf(fitted.hypothesis.model, *runs[r], fitted.runs[r].start);
    } catch (const model::ModelError&) {
      continue;
    }
    for (size_t s = 0; s + 1 < residuals.first.size(); ++s) {
      const double* x = residuals.values.data() + residuals.first[s];
      const size_t n = residuals.first[s + 1] - residuals.first[s];
      double variance = 0;
      for (size_t i = 0; i < n; ++i) variance += x[i] * x[i];
      // Sum until the correlation is lost (Geyer's initial positive sequence, in pairs).
      double sum = 1;
      for (size_t lag = 1; lag + 1 < n / 3 && variance > 0; lag += 2) {
        double pair = 0;
        for (size_t i = 0; i + lag < n; ++i) pair += x[i] * x[i + lag];
        for (size_t i = 0; i + lag + 1 < n; ++i) pair += x[i] * x[i + lag + 1];
        if (pair / variance < 0.02) break;
        sum += 2 * pair / variance;
      }
      weighted += sum * static_cast<double>(n);
      count += static_cast<double>(n);
    }
  }
  return count > 0 ? std::max(1.0, weighted / count) : 1;
}

}  // namespace hydro::diagnose
