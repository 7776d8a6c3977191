#include "diagnose/say/dependence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/number_text.h"

namespace hydro::diagnose {

namespace {

constexpr size_t kTableBins = 12;
constexpr size_t kFineBins = 48;    // what shows at low speeds alone needs narrow ones
constexpr double kMostOfIt = 0.85;  // share of the energy in the range that is named
constexpr double kNoPlace = 0.6;    // share of the blocks: a range with more is no place
constexpr size_t kBlocksOfAPart = 8, kMostParts = 48;
constexpr size_t kMostStretches = 5;  // in each run
constexpr double kChanceEnergy = 8;   // energy of a block that chance alone may have

std::vector<size_t> InOrderOf(const std::vector<double>& values) {
  std::vector<size_t> order(values.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) { return values[a] < values[b]; });
  return order;
}

// Where bins of equal count begin in a sorted list; equal values stay together.
std::vector<size_t> BinsOf(const std::vector<double>& values, const std::vector<size_t>& order,
                           size_t bins = kTableBins) {
  std::vector<size_t> first = {0};
  const size_t n = order.size();
  for (size_t bin = 1; bin < bins; ++bin) {
    size_t at = bin * n / bins;
    while (at > first.back() && at < n && values[order[at]] == values[order[at - 1]]) ++at;
    if (at > first.back() && at < n) first.push_back(at);
  }
  first.push_back(n);
  return first;
}

std::string Number(double value) { return ShortNumber(value, 3); }

double EnergyOfBlock(const Blocks::Block& block) {
  const double ratio = block.value / block.noise;
  return ratio * ratio - 1;
}

// What each block has of the lack's square: the mean of the blocks that are next to it in the order, squared, less what
// their scatter makes of it. A single block is mostly noise.
std::vector<double> SharesOf(const Blocks& blocks, const std::vector<size_t>& order) {
  const size_t n = order.size(), parts = std::clamp<size_t>(n / kBlocksOfAPart, 1, kMostParts);
  std::vector<double> shares(n);
  for (size_t part = 0; part < parts; ++part) {
    const size_t first = part * n / parts, end = (part + 1) * n / parts;
    const double count = static_cast<double>(end - first);
    double mean = 0, squares = 0;
    for (size_t i = first; i < end; ++i) {
      const double value = blocks.blocks[order[i]].value;
      mean += value / count;
      squares += value * value;
    }
    const double scatter = count > 1 ? (squares - count * mean * mean) / (count - 1) : 0;
    for (size_t i = first; i < end; ++i) shares[order[i]] = std::max(0.0, mean * mean - scatter / count);
  }
  return shares;
}

// The shortest stretch of the sorted blocks with most of the shares: its first block and one past its last. By parts, so
// that single blocks do not decide where it ends.
std::pair<size_t, size_t> Densest(const std::vector<double>& shares, const std::vector<size_t>& order) {
  std::vector<double> sum = {0};
  for (const size_t i : order) sum.push_back(sum.back() + shares[i]);
  const size_t n = order.size(), parts = std::min<size_t>(n, kMostParts);
  std::pair<size_t, size_t> best = {0, n};
  for (size_t from = 0; from < parts; ++from) {
    for (size_t to = from + 1; to <= parts; ++to) {
      const size_t first = from * n / parts, end = to * n / parts;
      if (end - first >= best.second - best.first) break;
      if (sum[end] - sum[first] >= kMostOfIt * sum[n]) {
        best = {first, end};
        break;
      }
    }
  }
  return best;
}

// Whether the mean is clearly positive on one side of 0 and negative on the other.
bool ChangesSign(const Blocks& blocks, const std::vector<double>& averages) {
  std::array<double, 2> sum{}, weight{};
  for (size_t i = 0; i < averages.size(); ++i) {
    const Blocks::Block& block = blocks.blocks[i];
    const size_t side = averages[i] > 0;
    sum[side] += block.value / (block.noise * block.noise);
    weight[side] += 1 / (block.noise * block.noise);
  }
  if (!(weight[0] > 0) || !(weight[1] > 0)) return false;
  const double below = sum[0] / std::sqrt(weight[0]), above = sum[1] / std::sqrt(weight[1]);
  return below * above < 0 && std::min(std::abs(below), std::abs(above)) > 5;
}

}  // namespace

std::vector<double> Average(const Variable& variable, const Blocks& blocks,
                            const std::vector<LackingRun>& runs, BalanceKind balance) {
  std::vector<double> averages;
  for (const Blocks::Block& block : blocks.blocks) {
    averages.push_back(
        MeanOver(block, runs[block.run], balance, [&](size_t i) { return variable.values[block.run][i]; }));
  }
  return averages;
}

double Explained(const Blocks& blocks, const std::vector<double>& variable, bool linear_only) {
  const size_t n = variable.size();
  if (n < 2 * kTableBins) return 0;
  double weights = 0, mean = 0, center = 0;
  for (size_t i = 0; i < n; ++i) {
    const double weight = 1 / (blocks.blocks[i].noise * blocks.blocks[i].noise);
    weights += weight;
    mean += weight * blocks.blocks[i].value;
    center += weight * variable[i];
  }
  mean /= weights;
  center /= weights;
  double total = 0, cross = 0, spread = 0;
  for (size_t i = 0; i < n; ++i) {
    const double weight = 1 / (blocks.blocks[i].noise * blocks.blocks[i].noise);
    const double value = blocks.blocks[i].value - mean, at = variable[i] - center;
    total += weight * value * value;
    cross += weight * value * at;
    spread += weight * at * at;
  }
  if (!(total > 0) || !(spread > 0)) return 0;
  const double count = static_cast<double>(n);
  const double beyond_noise = total - (count - 1);
  if (beyond_noise <= 0) return 0;
  const double by_line = 1 - (total - cross * cross / spread - (count - 2)) / beyond_noise;
  if (linear_only) return std::max(0.0, by_line);
  const std::vector<size_t> order = InOrderOf(variable);
  const std::vector<size_t> bins = BinsOf(variable, order, std::clamp(n / kTableBins, kTableBins, kFineBins));
  double left = 0;
  for (size_t bin = 0; bin + 1 < bins.size(); ++bin) {
    double sum = 0, squares = 0, weight_sum = 0;
    for (size_t i = bins[bin]; i < bins[bin + 1]; ++i) {
      const Blocks::Block& block = blocks.blocks[order[i]];
      const double weight = 1 / (block.noise * block.noise);
      weight_sum += weight;
      sum += weight * block.value;
      squares += weight * block.value * block.value;
    }
    left += squares - sum * sum / weight_sum;
  }
  const double by_bins = 1 - (left - (count - static_cast<double>(bins.size() - 1))) / beyond_noise;
  return std::max({0.0, by_line, by_bins});
}

MissingTerm TableOf(const Blocks& blocks, const Variable& variable, const std::vector<double>& averages) {
  MissingTerm table;
  table.against = variable.name;
  table.against_unit = variable.unit;
  const std::vector<size_t> order = InOrderOf(averages);
  const std::vector<size_t> bins = BinsOf(averages, order);
  for (size_t bin = 0; bin + 1 < bins.size(); ++bin) {
    const double count = static_cast<double>(bins[bin + 1] - bins[bin]);
    double at = 0, mean = 0, squares = 0, noise = 0;
    for (size_t i = bins[bin]; i < bins[bin + 1]; ++i) {
      const Blocks::Block& block = blocks.blocks[order[i]];
      at += averages[order[i]] / count;
      mean += block.value / count;
      noise += block.noise * block.noise / count;
    }
    for (size_t i = bins[bin]; i < bins[bin + 1]; ++i) {
      const double apart = blocks.blocks[order[i]].value - mean;
      squares += apart * apart;
    }
    const double variance = std::max(noise, count > 1 ? squares / (count - 1) : 0);
    table.at.push_back(at);
    table.mean.push_back(mean);
    table.error.push_back(std::sqrt(variance / count));
  }
  return table;
}

std::string RangeOf(const Blocks& blocks, const Variable& variable, const std::vector<double>& averages) {
  if (!variable.where.empty()) return variable.where;
  const size_t n = averages.size();
  if (n < kTableBins) return "everywhere";
  std::vector<double> sizes;
  sizes.reserve(averages.size());
  for (const double value : averages) sizes.push_back(std::abs(value));
  const std::vector<size_t> by_value = InOrderOf(averages), by_size = InOrderOf(sizes);
  const bool both_signs = averages[by_value.front()] < 0 && averages[by_value.back()] > 0;
  const std::vector<double> shares = SharesOf(blocks, by_value);
  const auto value = Densest(shares, by_value), size = Densest(shares, by_size);
  const bool use_size = both_signs && size.second - size.first <= value.second - value.first;
  const auto [first, end] = use_size ? size : value;
  if (static_cast<double>(end - first) > kNoPlace * static_cast<double>(n)) {
    return both_signs && ChangesSign(blocks, averages) ? "changes with the sign of " + variable.name
                                                       : "changes with " + variable.name;
  }
  const std::vector<double>& values = use_size ? sizes : averages;
  const std::vector<size_t>& order = use_size ? by_size : by_value;
  const std::string name = use_size ? "|" + variable.name + "|" : variable.name;
  const std::string unit = variable.unit.empty() ? "" : " " + variable.unit;
  const std::string low = Number(values[order[first]]), high = Number(values[order[end - 1]]);
  if (low == high) return name + " near " + low + unit;
  if (first == 0) return name + " < " + high + unit;
  if (end == n) return name + " > " + low + unit;
  return name + " from " + low + " to " + high + unit;
}

std::vector<Window> WindowsOf(const Blocks& blocks, const std::vector<LackingRun>& runs) {
  std::vector<Window> windows;
  for (size_t r = 0; r < runs.size(); ++r) {
    double largest = 0;
    for (const Blocks::Block& block : blocks.blocks) {
      if (block.run == r) largest = std::max(largest, EnergyOfBlock(block));
    }
    if (largest < kChanceEnergy) continue;
    struct Stretch {
      double from = 0, to = 0, energy = 0;
    };
    std::vector<Stretch> stretches;
    for (const Blocks::Block& block : blocks.blocks) {
      if (block.run != r || EnergyOfBlock(block) < std::max(kChanceEnergy, 0.2 * largest)) continue;
      const double from = runs[r].At(block.first).time, to = runs[r].At(block.end - 1).time;
      // Stretches less than a few blocks or 20 ms apart count as one.
      const bool joins =
          !stretches.empty() && from - stretches.back().to <= std::max(0.02, 2 * blocks.duration);
      if (!joins) stretches.push_back({from, to, 0});
      stretches.back().to = std::max(to, from + blocks.duration);
      stretches.back().energy += EnergyOfBlock(block);
    }
    std::stable_sort(stretches.begin(), stretches.end(),
                     [](const Stretch& a, const Stretch& b) { return a.energy > b.energy; });
    if (stretches.size() > kMostStretches) stretches.resize(kMostStretches);
    std::sort(stretches.begin(), stretches.end(),
              [](const Stretch& a, const Stretch& b) { return a.from < b.from; });
    for (const Stretch& stretch : stretches)
      windows.push_back({runs[r].motion.name, stretch.from, stretch.to});
  }
  return windows;
}

}  // namespace hydro::diagnose
