// What the balances of measured runs lack, and what the sensors' noise alone makes of them: over time, and in
// blocks.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <string>
#include <vector>

#include "diagnose/balances/balance_series.h"
#include "diagnose/recording/run_data.h"

namespace hydro::diagnose {

// "pump_torque", and the unit of its terms.
std::string NameOf(BalanceKind balance);
std::string UnitOf(BalanceKind balance, const UnitSystem& units);

// How often noise is drawn. Two draws suffice because the size of the noise over a block comes from many
// blocks.
inline constexpr size_t kNoiseDraws = 2;

// All series have one value for every stride-th instant of the run's motion. A series is empty where a
// balance cannot be formed.
struct LackingRun {
  RunMotion motion;  // without what the model's effects add to readings
  BaseSeries base;   // what the model leaves; the lacking torque or flow is its negative
  std::array<BalanceSeries, kNoiseDraws> noise;                // the changes from adding noise once more
  std::array<std::vector<uint8_t>, kBalanceKinds> masks = {};  // 1: the balance says nothing
  // How much an instant counts, from 0 (masked) rising smoothly to 1. Under smooth weights the noise of a
  // derivative averages out; under weights with steps it hardly does.
  std::array<Eigen::VectorXd, kBalanceKinds> weights = {};

  const model::KnownMotion& At(size_t i) const { return motion.at[i * motion.stride]; }
  size_t size() const { return (motion.size() + motion.stride - 1) / motion.stride; }
};

// The error of a pressure reading, in the model's unit; positive: it reads too high.
struct PressureOffsets {
  double p1 = 0, p2 = 0;
};

// `offsets` are subtracted from the measured pressures. Throws ModelError as Equations does.
std::vector<LackingRun> LackingIn(const model::ModelDescription& model,
                                  const std::vector<const RunData*>& runs, int jobs,
                                  const PressureOffsets& offsets = {});

// A stretch of a run over which a balance is averaged. Its weights reach smoothly into its neighbours by half
// its length.
struct Block {
  size_t run = 0, first = 0, end = 0;  // instants, nominal
  double value = 0, noise = 0;         // mean of what the balance lacks, and its standard error by noise
};

// Blocks from all runs that have the balance, where it says something in at least half of the block.
// `duration`: s, nominal.
std::vector<Block> BlocksOf(const std::vector<LackingRun>& runs, BalanceKind balance, double duration);

// The mean of any series of the block's run under the block's weights: a raised cosine over twice its length,
// times the weights of the instants. `of(i)` is the series at an instant. NaN where less than half a block
// remains.
template <class Of>
double MeanOver(const Block& block, const LackingRun& run, BalanceKind balance, const Of& of) {
  const Eigen::VectorXd& weights = run.weights[static_cast<size_t>(balance)];
  const size_t length = block.end - block.first;
  const double middle = 0.5 * static_cast<double>(block.first + block.end - 1);
  double sum = 0, count = 0;
  for (size_t i = block.first - std::min(block.first, length / 2);
       i < std::min(static_cast<size_t>(weights.size()), block.end + length / 2); ++i) {
    const double away = (static_cast<double>(i) - middle) / static_cast<double>(length);
    const double weight = weights[static_cast<Eigen::Index>(i)] *
                          std::pow(std::cos(0.5 * std::numbers::pi * std::clamp(away, -1.0, 1.0)), 2);
    if (!(weight > 0)) continue;
    sum += weight * of(i);
    count += weight;
  }
  return 2 * count < static_cast<double>(length) ? std::numeric_limits<double>::quiet_NaN() : sum / count;
}
// The same for a balance's own series.
double MeanOver(const Block& block, const LackingRun& run, BalanceKind balance, const BalanceSeries& series);

}  // namespace hydro::diagnose
