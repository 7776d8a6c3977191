#include "diagnose/locate/disagreement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "diagnose/data/sample_interval.h"

namespace hydro::diagnose {

namespace {

constexpr std::array<double, 6> kDurations = {0, 0.004, 0.016, 0.064, 0.256, 1.024};  // s
// The least significance, in standard deviations, and the least share of the noise's energy: the smoother
// linearises and holds each mode over a sample, and the errors of that stay below these limits.
constexpr double kSignificant = 8;
constexpr double kMaterial = 0.1;
constexpr double kPlain = 25;          // standard deviations that suffice by themselves
constexpr size_t kEnoughBlocks = 100;  // to see a dependence
constexpr size_t kNear = 16;           // blocks on either side whose noise is averaged

Disagreement AtDuration(const std::vector<SmoothedRun>& smoothed, const std::vector<const RunData*>& runs,
                        Balance balance, double duration) {
  Disagreement result;
  result.blocks.duration = duration;
  std::vector<Blocks::Block>& blocks = result.blocks.blocks;
  const size_t b = static_cast<size_t>(balance);
  double chi_squared = 0;
  for (size_t r = 0; r < runs.size(); ++r) {
    if (!smoothed[r].measured[b]) continue;
    const Disturbance& d = smoothed[r].disturbance[b];
    const size_t samples = d.value.size();
    const size_t length =
        static_cast<size_t>(std::max(1.0, std::round(duration / MedianInterval(runs[r]->stimulus.time))));
    const size_t before = blocks.size();
    std::vector<double> drawn = {0};  // cumulative sums of the draws' squares
    for (size_t first = 0; first < samples; first += length) {
      const size_t end = std::min(samples, first + length);
      double sum = 0;
      std::array<double, kNoiseDraws> noise{};
      size_t count = 0;
      for (size_t k = first; k < end; ++k) {
        if (!d.informative[k]) continue;
        ++count;
        sum += d.value[k];
        for (size_t draw = 0; draw < kNoiseDraws; ++draw) noise[draw] += d.noise[draw][k];
      }
      if (2 * count < length) continue;
      const double informative = static_cast<double>(count);
      double squares = 0;
      for (const double value : noise) squares += value * value / (informative * informative);
      drawn.push_back(drawn.back() + squares / kNoiseDraws);
      blocks.push_back({r, first, end, sum / informative, 0});
    }
    const size_t count = blocks.size() - before;
    for (size_t i = 0; i < count; ++i) {
      const size_t first = i < kNear ? 0 : i - kNear, end = std::min(count, i + kNear + 1);
      Blocks::Block& block = blocks[before + i];
      block.noise = std::sqrt((drawn[end] - drawn[first]) / static_cast<double>(end - first));
      if (!(block.noise > 0)) block.noise = std::numeric_limits<double>::infinity();
      chi_squared += block.value * block.value / (block.noise * block.noise);
    }
  }
  const double count = static_cast<double>(blocks.size());
  if (count == 0) return result;
  result.energy = chi_squared - count;
  // The noise is known only from the draws.
  result.significance = result.energy / std::sqrt(2 * count * (1 + 1.0 / kNoiseDraws));
  result.beyond_noise = result.significance > kPlain ||
                        (result.significance > kSignificant && result.energy > kMaterial * count);
  return result;
}

}  // namespace

Disagreement LargestDisagreement(const std::vector<SmoothedRun>& smoothed,
                                 const std::vector<const RunData*>& runs, Balance balance) {
  Disagreement largest;
  double shown = 0;
  for (const double duration : kDurations) {
    Disagreement d = AtDuration(smoothed, runs, balance, duration);
    if (d.blocks.blocks.size() < 3) continue;
    const bool enough = d.blocks.blocks.size() >= kEnoughBlocks;
    if (largest.blocks.blocks.empty() || (enough && d.energy > shown)) {
      shown = d.energy;
      largest.blocks = std::move(d.blocks);
    }
    if (d.energy > largest.energy) {
      largest.energy = d.energy;
      largest.significance = d.significance;
      largest.beyond_noise = d.beyond_noise;
    }
  }
  return largest;
}

}  // namespace hydro::diagnose
