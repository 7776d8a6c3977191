#include "diagnose/say/seen.h"

#include <numeric>
#include <utility>

#include "base/number_text.h"

namespace hydro::diagnose {
namespace {

// s, nominal lengths of blocks: small and slow effects show best in long blocks, quick ones in short blocks.
constexpr double kBlockLengths[] = {0.002, 0.008, 0.016, 0.032, 0.064, 0.128, 0.256};
// s: in shorter blocks the derivatives of measured signals are mostly noise.
constexpr double kSlow = 0.03;
// The numbers of blocks needed to see anything, and to see a dependence: four for each of two dozen bins.
constexpr size_t kFewestBlocks = 3, kEnoughBlocks = 100;
// The share of the variance that a variable has to explain beyond a simpler one, or beyond none.
constexpr double kPlainly = 0.06;
// How much larger the noise's variance may be than the draws say. There are few draws, sensors that count are
// treated as noisy ones, and blocks that overlap by half have a third more noise together than alone.
constexpr double kNoiseMargin = 1.5;
// The least energy of a curve over a variable, from means over two dozen bins. By chance the energy is 0 with
// a standard deviation of 7, and the best of a dozen variables over seven lengths is taken; near reversals of
// the pump it is not entirely chance.
constexpr double kSignificant = 60;
// The least energy for each block where no variable shows anything: sensors that count and differences of
// slow signals produce as much as this.
constexpr double kPlain = 3;
constexpr double kMostOfIt = 0.85;    // of the lack, in the range that is named
constexpr double kNoPlace = 0.6;      // of the blocks: a larger range is no place
constexpr size_t kMostStretches = 5;  // in each run

double EnergyOfBlock(const Block& block) { return std::pow(block.value / block.noise, 2) - 1; }

// Sum of (value/noise)^2, less what noise contributes.
double EnergyOf(const std::vector<Block>& blocks) {
  double energy = 0;
  for (const Block& block : blocks) energy += std::pow(block.value / block.noise, 2) - kNoiseMargin;
  return energy;
}

// What means over bins show beyond their scatter; for a line, what it removes of the blocks' scatter.
double EnergyOver(const std::vector<Block>& blocks, const Dependence& d) {
  if (d.variable.line) return d.explained * std::max(0.0, EnergyOf(blocks));
  double energy = 0;
  for (size_t i = 0; i < d.curve.size(); ++i)
    energy += std::pow(d.curve.measured[i] / d.curve.error[i], 2) - kNoiseMargin;
  return energy;
}

// A sequence of consecutive bins, in some order of them.
struct Stretch {
  double low = 0, high = 0, count = 0;
  bool from_first = false, to_last = false;
};

// The shortest sequence of bins, in order of `at`, with most of the lack's square.
Stretch Densest(const BinnedCurve& curve, bool by_size) {
  const auto size = [by_size](double at) { return by_size ? std::abs(at) : at; };
  std::vector<size_t> order(curve.size());
  std::iota(order.begin(), order.end(), size_t{0});
  std::ranges::stable_sort(order, [&](size_t a, size_t b) { return size(curve.at[a]) < size(curve.at[b]); });
  // A mean of twice its error may be due to chance.
  const auto share = [&](size_t bin) {
    return curve.count[bin] *
           std::max(0.0, std::pow(curve.measured[bin], 2) - std::pow(2 * curve.error[bin], 2));
  };
  double all = 0;
  for (const size_t bin : order) all += share(bin);
  Stretch best;
  best.count = std::numeric_limits<double>::infinity();
  for (size_t first = 0; first < order.size() && all > 0; ++first) {
    double sum = 0;
    Stretch here;
    here.low = std::numeric_limits<double>::infinity();
    here.high = -here.low;
    for (size_t i = first; i < order.size(); ++i) {
      const size_t bin = order[i];
      sum += share(bin);
      here.count += curve.count[bin];
      here.low = std::min({here.low, size(curve.low[bin]), size(curve.high[bin])});
      here.high = std::max({here.high, size(curve.low[bin]), size(curve.high[bin])});
      if (sum < kMostOfIt * all) continue;
      // One bin more or less at an end is due to chance.
      here.from_first = first <= 1;
      here.to_last = i + 2 >= order.size();
      if (here.count < best.count) best = here;
      break;
    }
  }
  return best;
}

// Whether the lack has one sign below 0 and the other above.
bool ChangesSign(const BinnedCurve& curve) {
  double below = 0, above = 0;
  for (size_t i = 0; i < curve.size(); ++i)
    (curve.at[i] < 0 ? below : above) += curve.count[i] * curve.measured[i];
  return below * above < 0;
}

}  // namespace

std::vector<CurvePoint> PointsOver(const Variable& variable, const std::vector<Block>& blocks,
                                   const std::vector<LackingRun>& runs, BalanceKind balance) {
  std::vector<CurvePoint> points;
  for (const Block& block : blocks) {
    const std::vector<double>& values = variable.values[block.run];
    const double at = MeanOver(block, runs[block.run], balance, [&](size_t i) { return values[i]; });
    points.push_back({at, block.value, block.noise});
  }
  return points;
}

std::vector<Dependence> Ranked(const std::vector<Block>& blocks, std::vector<Variable> variables,
                               const std::vector<LackingRun>& runs, BalanceKind balance) {
  std::vector<Dependence> ranked;
  double best = 0;
  for (Variable& variable : variables) {
    Dependence d;
    const std::vector<CurvePoint> points = PointsOver(variable, blocks, runs, balance);
    d.curve = Binned(points);
    d.explained = Explained(points, FineBins(points), variable.line);
    d.variable = std::move(variable);
    d.energy = EnergyOver(blocks, d);
    best = std::max(best, d.explained);
    ranked.push_back(std::move(d));
  }
  const double enough = std::max(best - kPlainly, 1 - std::max(kPlainly, (1 - best) / kFarLess));
  const auto simplest =
      std::ranges::find_if(ranked, [enough](const Dependence& d) { return d.explained >= enough; });
  std::rotate(ranked.begin(), simplest, simplest + 1);
  std::stable_sort(ranked.begin() + 1, ranked.end(),
                   [](const Dependence& a, const Dependence& b) { return a.explained > b.explained; });
  return ranked;
}

std::string WhereOf(const Dependence& dependence) {
  const auto& [variable, curve, explained, energy] = dependence;
  if (explained < kPlainly) return "the same everywhere";
  if (!variable.where.empty()) return variable.where;
  if (curve.size() == 0) return "changes with " + variable.name;
  const bool both_signs = curve.low.front() < 0 && curve.high.back() > 0;
  Stretch place = Densest(curve, false);
  const Stretch size = Densest(curve, true);
  const bool use_size = both_signs && size.count <= place.count;
  if (use_size) place = size;
  if (place.count > kNoPlace * std::accumulate(curve.count.begin(), curve.count.end(), 0.0)) {
    return (both_signs && ChangesSign(curve) ? "changes with the sign of " : "changes with ") + variable.name;
  }
  const std::string name = use_size ? "|" + variable.name + "|" : variable.name;
  const std::string unit = variable.unit.empty() ? "" : " " + variable.unit;
  const std::string low = ShortNumber(place.low, 3), high = ShortNumber(place.high, 3);
  if (low == high) return name + " near " + low + unit;
  if (place.from_first) return name + " < " + high + unit;
  if (place.to_last) return name + " > " + low + unit;
  return name + " from " + low + " to " + high + unit;
}

std::vector<Window> WindowsOf(const std::vector<Block>& blocks, const std::vector<LackingRun>& runs) {
  std::vector<double> largest(runs.size());
  for (const Block& block : blocks) largest[block.run] = std::max(largest[block.run], EnergyOfBlock(block));
  std::vector<Window> windows;
  for (size_t r = 0; r < runs.size(); ++r) {
    std::vector<std::pair<double, Window>> stretches;  // with their energies
    for (const Block& block : blocks) {
      // A fifth of the largest deserves mention beside it.
      if (block.run != r || EnergyOfBlock(block) < std::max(kPlain, 0.2 * largest[r])) continue;
      const double from = runs[r].At(block.first).time, to = runs[r].At(block.end - 1).time;
      // Stretches less than two blocks or 20 ms apart count as one.
      const double apart = std::max(0.02, 2 * (to - from));
      if (stretches.empty() || from - stretches.back().second.to > apart)
        stretches.push_back({0, {runs[r].motion.name, from, to}});
      const double next = block.end < runs[r].size() ? runs[r].At(block.end).time : to;
      stretches.back().second.to = next;
      stretches.back().first += EnergyOfBlock(block);
    }
    std::ranges::stable_sort(stretches, [](const auto& a, const auto& b) { return a.first > b.first; });
    if (stretches.size() > kMostStretches) stretches.resize(kMostStretches);
    std::ranges::sort(stretches, [](const auto& a, const auto& b) { return a.second.from < b.second.from; });
    for (const auto& [energy, window] : stretches) windows.push_back(window);
  }
  return windows;
}

Seen LookAt(const std::vector<LackingRun>& runs, BalanceKind balance, const UnitSystem& units) {
  Seen seen;
  double most = 0, curve = 0, explained = 0;
  for (const double duration : kBlockLengths) {
    std::vector<Block> blocks = BlocksOf(runs, balance, duration);
    if (blocks.size() < kFewestBlocks) break;
    const double energy = EnergyOf(blocks);
    if (seen.when.empty() || energy > most) seen.when = blocks, most = energy;
    if (blocks.size() < kEnoughBlocks && !seen.ranked.empty()) continue;
    std::vector<Variable> variables = MotionVariables(runs, balance, units, duration == kBlockLengths[0]);
    if (duration < kSlow) std::erase_if(variables, [](const Variable& one) { return one.only_names; });
    std::vector<Dependence> ranked = Ranked(blocks, std::move(variables), runs, balance);
    for (const Dependence& d : ranked) {
      if (!d.variable.only_names) curve = std::max(curve, d.energy);
    }
    const double here = ranked.front().explained * std::max(0.0, energy);
    if (!seen.ranked.empty() && here <= explained) continue;
    explained = here;
    seen.where = std::move(blocks);
    seen.ranked = std::move(ranked);
  }
  const bool plain = most > kPlain * static_cast<double>(seen.when.size());
  if (plain || curve > kSignificant) seen.energy = std::max(most, curve);
  return seen;
}

}  // namespace hydro::diagnose
