#include "diagnose/say/seen.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "diagnose/say/dependence.h"

namespace hydro::diagnose {

namespace {

// The extra share of the variance that a variable must explain to be preferred to a simpler one.
constexpr double kPlainly = 0.06;
// The least energy of a curve over a variable, of means over 12 bins: by chance it is 0 with a standard deviation of 5, and the
// best of a dozen variables is taken.
constexpr double kSignificant = 40;
// The least energy, for each block, where no variable shows anything: sensors that count and differences of slow signals
// make as much as this.
constexpr double kPlain = 3;
// s: in shorter blocks the derivatives of measured signals are mostly noise.
constexpr double kSlow = 0.03;
constexpr size_t kEnoughBlocks = 60;  // to see a dependence
// s: longer blocks miss what repeats within a turn.
constexpr double kQuick = 0.005;

// What means over bins show beyond their scatter; of a line, what it takes of the blocks' scatter.
double EnergyOf(const Blocks& blocks, const Dependence& d) {
  if (d.variable.linear_only) {
    double squares = 0;
    for (const Blocks::Block& block : blocks.blocks) squares += std::pow(block.value / block.noise, 2);
    const double count = static_cast<double>(blocks.blocks.size());
    return d.explained * (squares - count) * count / squares;
  }
  const MissingTerm table = TableOf(blocks, d.variable, d.averages);
  double energy = 0;
  for (size_t i = 0; i < table.at.size(); ++i) energy += std::pow(table.mean[i] / table.error[i], 2) - 1;
  return energy;
}

// The largest energy of a curve over any variable.
double LargestCurve(const Blocks& blocks, const std::vector<Dependence>& ranked) {
  double energy = 0;
  for (const Dependence& d : ranked) {
    if (!d.variable.only_names) energy = std::max(energy, EnergyOf(blocks, d));
  }
  return energy;
}

}  // namespace

std::vector<Dependence> Ranked(const Blocks& blocks, std::vector<Variable> variables,
                               const std::vector<LackingRun>& runs, BalanceKind balance) {
  std::vector<Dependence> ranked;
  for (Variable& variable : variables) {
    if (variable.only_names && blocks.duration < kSlow) continue;
    Dependence d;
    d.averages = Average(variable, blocks, runs, balance);
    d.explained = Explained(blocks, d.averages, variable.linear_only);
    d.variable = std::move(variable);
    d.simplicity = ranked.size();
    ranked.push_back(std::move(d));
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const Dependence& a, const Dependence& b) { return a.explained > b.explained; });
  const double best = ranked.front().explained;
  auto simplest = ranked.begin();
  for (auto d = ranked.begin(); d != ranked.end() && d->explained >= best - kPlainly; ++d) {
    if (d->simplicity < simplest->simplicity) simplest = d;
  }
  std::rotate(ranked.begin(), simplest, simplest + 1);
  return ranked;
}

Seen LookAt(const std::vector<LackingRun>& runs, BalanceKind balance, const UnitSystem& units) {
  Seen seen;
  seen.when = LargestBlocks(runs, balance);
  if (seen.when.blocks.empty()) return seen;
  double curve = 0, explained = 0;
  for (const double duration : kBlockLengths) {
    Blocks blocks = BlocksOf(runs, balance, duration);
    if (blocks.blocks.size() < kEnoughBlocks && !seen.ranked.empty()) break;
    std::vector<Dependence> ranked =
        Ranked(blocks, MotionVariables(runs, balance, units, duration < kQuick), runs, balance);
    curve = std::max(curve, LargestCurve(blocks, ranked));
    const double here = ranked.front().explained * std::max(0.0, EnergyOf(blocks));
    if (!seen.ranked.empty() && here <= explained) continue;
    explained = here;
    seen.where = std::move(blocks);
    seen.ranked = std::move(ranked);
  }
  const double all = EnergyOf(seen.when);
  const bool plain = all > kPlain * static_cast<double>(seen.when.blocks.size());
  if (plain || curve > kSignificant) seen.energy = std::max(all, curve);
  return seen;
}

}  // namespace hydro::diagnose
