#include "diagnose/balances/rows_to_read.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>

#include "base/maths/spread.h"
#include "runs/measured/sample_times.h"

namespace hydro::diagnose {
namespace {

// Estimates of one sensor's noise from several runs are within 5 % of each other, unless it mostly rests.
constexpr double kFarBelow = 0.5;
constexpr size_t kFewestToCompare = 3;
// The samples of all runs together: what a whole catalogue's columns take some 20 s for.
constexpr double kMostSamples = 80000, kAFewMore = 0.05;

}  // namespace

std::vector<std::array<double, kGridChannels>> LeastNoises(const std::vector<const RunData*>& runs) {
  std::vector<std::array<double, kGridChannels>> least(runs.size());
  for (size_t s = 0; s < kGridChannels; ++s) {
    std::map<std::string, std::vector<double>> of_sensors;  // by column
    std::vector<double> noises(runs.size(), 0.0);
    for (size_t r = 0; r < runs.size(); ++r) {
      least[r][s] = 0;
      const runs::MeasuredSignal& signal = runs[r]->measured.*kSignalOf[s];
      if (!signal.measured() || signal.noise.has_value()) continue;
      noises[r] = EstimateNoise(signal.values);
      of_sensors[signal.source.column].push_back(noises[r]);
    }
    for (size_t r = 0; r < runs.size(); ++r) {
      const std::vector<double>& all = of_sensors[(runs[r]->measured.*kSignalOf[s]).source.column];
      if (noises[r] == 0 || all.size() < kFewestToCompare) continue;
      const double usual = maths::Median(all);
      if (noises[r] < kFarBelow * usual) least[r][s] = usual;
    }
  }
  return least;
}

RowsRead RowsToRead(const std::vector<const RunData*>& runs) {
  double samples = 0, interval = 0;
  for (const RunData* run : runs) {
    samples += static_cast<double>(run->samples());
    interval = std::max(interval, runs::MedianInterval(run->stimulus.time));
  }
  const double times = samples / kMostSamples;
  RowsRead read;
  if (times <= 1) return read;
  // Coarser samples than the balances need would lose more than a part of each run does.
  const double coarsest = std::max(1.0, std::floor(kBalanceStep / interval * (1 + 1e-9)));
  read.every = static_cast<size_t>(std::min(std::ceil(times - kAFewMore), coarsest));
  read.part = std::min(1.0, static_cast<double>(read.every) / times);
  return read;
}

size_t StartOfBusiest(const std::vector<double>& happened, size_t count) {
  size_t first = 0;
  for (size_t k = 0; k + count < happened.size(); ++k) {
    if (happened[k + count] - happened[k] > happened[first + count] - happened[first]) first = k;
  }
  return first;
}

RunMotion BusiestPart(RunMotion motion, double part) {
  const size_t n = motion.size();
  const auto count = static_cast<size_t>(std::lround(part * static_cast<double>(n)));
  if (count >= n || n < 2) return motion;
  // How much happens up to each instant, in ranges of command and speed.
  std::vector<double> happened(n, 0.0);
  for (double model::KnownMotion::*one : {&model::KnownMotion::voltage, &model::KnownMotion::motor_speed}) {
    double low = motion.at[0].*one, high = low;
    for (const model::KnownMotion& at : motion.at) {
      low = std::min(low, at.*one);
      high = std::max(high, at.*one);
    }
    double sum = 0;
    for (size_t k = 1; k < n && high > low; ++k) {
      sum += std::abs(motion.at[k].*one - motion.at[k - 1].*one) / (high - low);
      happened[k] += sum;
    }
  }
  const size_t first = StartOfBusiest(happened, count);
  const auto keep = [&](auto* values) {
    if (values->size() != n) return;
    values->erase(values->begin() + static_cast<std::ptrdiff_t>(first + count), values->end());
    values->erase(values->begin(), values->begin() + static_cast<std::ptrdiff_t>(first));
  };
  keep(&motion.voltage);
  keep(&motion.around);
  for (GridSignal& signal : motion.signals) {
    keep(&signal.values);
    keep(&signal.gap);
  }
  keep(&motion.at);
  return motion;
}

}  // namespace hydro::diagnose
