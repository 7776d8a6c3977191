// What the balances of measured runs lack, beside what the sensors' noise alone makes of them.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "diagnose/balances/balance_series.h"
#include "diagnose/data/run_data.h"

namespace hydro::diagnose {

// "pump_torque", and the unit of its terms.
std::string NameOf(BalanceKind balance);
std::string UnitOf(BalanceKind balance, const UnitSystem& units);

// So many times noise is drawn: its size over a block comes from many blocks.
inline constexpr size_t kNoiseDraws = 2;

// Everything by every stride-th instant of the run's motion. Series are empty where a balance cannot be formed.
struct LackingRun {
  RunMotion motion;       // less what the model's effects add to readings
  BaseSeries base;        // what the model leaves
  BalanceSeries lacking;  // the torque or flow that it lacks: the same with the other sign
  std::array<BalanceSeries, kNoiseDraws> noise;                // what noise added once more changes
  std::array<std::vector<uint8_t>, kBalanceKinds> masks = {};  // 1: the balance says nothing
  // How much an instant counts, 0 to 1: 0 where masked, rising smoothly from there. A derivative's noise averages out under
  // weights without steps, and hardly under others.
  std::array<Eigen::VectorXd, kBalanceKinds> weights = {};

  const model::KnownMotion& At(size_t i) const { return motion.at[i * motion.stride]; }
  // Whether the balance is there, and says something, at an instant.
  bool Says(BalanceKind balance, size_t i) const {
    const std::vector<uint8_t>& mask = masks[static_cast<size_t>(balance)];
    return i < mask.size() && mask[i] == 0;
  }
  size_t size() const { return (motion.size() + motion.stride - 1) / motion.stride; }
};

// What a pressure reads too much, in the model's unit.
struct PressureOffsets {
  double p1 = 0, p2 = 0;
};

// `offsets` are taken off what was measured. Throws ModelError as Equations does.
std::vector<LackingRun> LackingIn(const model::ModelDescription& model,
                                  const std::vector<const RunData*>& runs, int jobs,
                                  const PressureOffsets& offsets = {});

// What a balance lacks, averaged over stretches of equal length, of all runs that have the balance. Each reaches smoothly half
// a length into its neighbours.
struct Blocks {
  double duration = 0;  // s, nominal
  struct Block {
    size_t run = 0, first = 0, end = 0;  // instants, nominal
    double value = 0, noise = 0;         // mean where the balance says something, its standard error by noise
  };
  std::vector<Block> blocks;
};

// `duration`: s.
Blocks BlocksOf(const std::vector<LackingRun>& runs, BalanceKind balance, double duration);
// The mean of any series of the block's run under the block's weights. `of(i)`: its value at an instant.
template <class Of>
double MeanOver(const Blocks::Block& block, const LackingRun& run, BalanceKind balance, const Of& of);

// Blocks' sum of (value/noise)^2, less what noise contributes. Where noise is known from few draws, and counted sensors are
// taken to be noisy ones, it may contribute half as much again.
double EnergyOf(const Blocks& blocks);

// s, nominal lengths of blocks: what is small and slow shows best in long ones, what is quick in short ones.
inline constexpr std::array<double, 7> kBlockLengths = {0.002, 0.008, 0.016, 0.032, 0.064, 0.128, 0.256};

// The blocks of the length at which most shows; empty where the balance cannot be formed.
Blocks LargestBlocks(const std::vector<LackingRun>& runs, BalanceKind balance);

// A raised cosine over twice the block's length, times the instants' own weights. Calls visit(i, weight) where it is not 0.
template <class Visit>
void VisitBlock(const Blocks::Block& block, const Eigen::VectorXd& weights, const Visit& visit) {
  const size_t length = block.end - block.first;
  const double middle = 0.5 * static_cast<double>(block.first + block.end - 1);
  const size_t from = block.first - std::min(block.first, length / 2);
  const size_t to = std::min(static_cast<size_t>(weights.size()), block.end + length / 2);
  for (size_t i = from; i < to; ++i) {
    const double away = (static_cast<double>(i) - middle) / static_cast<double>(length);
    const double weight = weights[static_cast<Eigen::Index>(i)] *
                          std::pow(std::cos(0.5 * std::numbers::pi * std::clamp(away, -1.0, 1.0)), 2);
    if (weight > 0) visit(i, weight);
  }
}

template <class Of>
double MeanOver(const Blocks::Block& block, const LackingRun& run, BalanceKind balance, const Of& of) {
  double sum = 0, count = 0;
  VisitBlock(block, run.weights[static_cast<size_t>(balance)], [&](size_t i, double weight) {
    sum += weight * of(i);
    count += weight;
  });
  return sum / count;
}

}  // namespace hydro::diagnose
