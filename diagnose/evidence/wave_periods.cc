#include "diagnose/evidence/wave_periods.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

#include "base/parallel.h"

namespace hydro::diagnose {
namespace {

// One period a turn is an eccentric shaft, which every hypothesis has.
constexpr int kFirstPeriod = 2;
// How often a wave has to be seen to repeat.
constexpr double kSeen = 2;
// How many periods of each effect are kept: the true one and its strongest neighbour.
constexpr size_t kKept = 2;

using Gains = std::map<std::string, double>;  // by set

// What each set of waves gains in one run beyond the columns of every hypothesis.
Gains GainsIn(size_t run, const Rows& waves, const Rows& rows, const SetFit& null) {
  std::vector<double> amount(rows.columns.size(), 0.0);
  for (size_t i = 0; i < null.columns.size(); ++i)
    amount[static_cast<size_t>(null.columns[i])] = null.amounts[static_cast<Eigen::Index>(i)];
  const auto count = static_cast<Eigen::Index>(null.columns.size());
  std::map<int, Eigen::Index> always;
  for (size_t i = 0; i < null.columns.size(); ++i) always[null.columns[i]] = static_cast<Eigen::Index>(i);
  std::map<int, Eigen::Index> own;
  for (size_t b = 0; b < waves.blocks.size(); ++b) {
    if (waves.blocks[b].run != run) continue;
    for (const int column : waves.blocks[b].columns)
      own.emplace(column, static_cast<Eigen::Index>(own.size()));
  }
  const auto size = static_cast<Eigen::Index>(own.size());
  Eigen::MatrixXd AA(count, count);
  Eigen::MatrixXd prior(count, count);
  for (Eigen::Index i = 0; i < count; ++i) {
    for (Eigen::Index j = 0; j < count; ++j)
      prior(i, j) = rows.prior(null.columns[static_cast<size_t>(i)], null.columns[static_cast<size_t>(j)]);
  }
  AA = prior.llt().solve(Eigen::MatrixXd::Identity(count, count));
  Eigen::MatrixXd ZA = Eigen::MatrixXd::Zero(size, count), ZZ = Eigen::MatrixXd::Zero(size, size);
  Eigen::VectorXd Ze = Eigen::VectorXd::Zero(size);
  for (size_t b = 0; b < waves.blocks.size(); ++b) {
    const RowBlock& wave = waves.blocks[b];
    if (wave.run != run || wave.columns.empty()) continue;
    const auto block = std::ranges::find_if(
        rows.blocks, [&](const RowBlock& one) { return one.run == run && one.balance == wave.balance; });
    if (block == rows.blocks.end() || block->X.rows() != wave.X.rows()) continue;
    Eigen::VectorXd root = Eigen::VectorXd::Zero(block->y.size());
    for (Eigen::Index i = 0; i < root.size(); ++i) {
      for (const GroupFit& group : null.groups) {
        if (group.run == run && group.balance == wave.balance &&
            group.band == block->band[static_cast<size_t>(i)])
          root[i] = std::sqrt(kIndependentShare * group.weight);
      }
    }
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(block->X.rows(), count);
    Eigen::VectorXd left = block->y;
    for (size_t c = 0; c < block->columns.size(); ++c) {
      const auto place = always.find(block->columns[c]);
      if (place == always.end()) continue;
      A.col(place->second) = block->X.col(static_cast<Eigen::Index>(c)).cwiseProduct(root);
      left += amount[static_cast<size_t>(block->columns[c])] * block->X.col(static_cast<Eigen::Index>(c));
    }
    left = left.cwiseProduct(root);
    Eigen::MatrixXd Z = Eigen::MatrixXd::Zero(wave.X.rows(), size);
    for (size_t c = 0; c < wave.columns.size(); ++c)
      Z.col(own.at(wave.columns[c])) = wave.X.col(static_cast<Eigen::Index>(c)).cwiseProduct(root);
    AA += A.transpose() * A;
    ZA += Z.transpose() * A;
    ZZ += Z.transpose() * Z;
    Ze += Z.transpose() * left;
  }
  const Eigen::MatrixXd H = ZZ - ZA * AA.llt().solve(ZA.transpose());
  std::map<std::string, std::vector<Eigen::Index>> sets;
  for (const auto& [column, place] : own)
    sets[waves.columns[static_cast<size_t>(column)].set].push_back(place);
  Gains gains;
  for (const auto& [set, places] : sets) {
    const auto n = static_cast<Eigen::Index>(places.size());
    Eigen::MatrixXd part = Eigen::MatrixXd::Identity(n, n);
    Eigen::VectorXd slope(n);
    for (Eigen::Index i = 0; i < n; ++i) {
      slope[i] = Ze[places[static_cast<size_t>(i)]];
      for (Eigen::Index j = 0; j < n; ++j)
        part(i, j) += H(places[static_cast<size_t>(i)], places[static_cast<size_t>(j)]);
    }
    const Eigen::LLT<Eigen::MatrixXd> factor(part);
    gains[set] = 0.5 * slope.dot(factor.solve(slope)) - factor.matrixLLT().diagonal().array().log().sum();
  }
  return gains;
}

}  // namespace

int FewestPeriods(const std::vector<RunMotion>& runs) {
  double turns = 0;
  for (const RunMotion& run : runs) {
    const auto [least, most] =
        std::minmax_element(run.at.begin(), run.at.end(),
                            [](const auto& a, const auto& b) { return a.motor_angle < b.motor_angle; });
    if (!run.at.empty())
      turns = std::max(turns, (most->motor_angle - least->motor_angle) / (2 * std::numbers::pi));
  }
  const bool none = turns * kMostPeriods < kSeen;
  return none ? kMostPeriods + 1 : std::max(kFirstPeriod, static_cast<int>(std::ceil(kSeen / turns)));
}

std::vector<int> LikelyPeriods(const ScanRuns& runs, const Rows& rows, const SetEvidence& evidence,
                               int jobs) {
  const int fewest = FewestPeriods(runs.motions());
  if (fewest > kMostPeriods) return {};
  std::vector<int> all;
  for (int periods = kFirstPeriod; periods <= kMostPeriods; ++periods) all.push_back(periods);
  const Rows waves = runs.MakeWaveRows(all);
  if (waves.columns.empty()) return {};
  const SetFit null = evidence.Fit({});
  std::vector<Gains> each(runs.motions().size());
  ParallelFor(each.size(), jobs, [&](size_t run) { each[run] = GainsIn(run, waves, rows, null); });
  // By effect, the gain of each number of periods over all runs.
  std::map<std::string, std::vector<std::pair<double, int>>> by_effect;
  Gains total;
  for (const Gains& gains : each) {
    for (const auto& [set, gain] : gains) total[set] += gain;
  }
  for (const auto& [set, gain] : total) {
    const size_t bar = set.find('|');
    by_effect[set.substr(0, bar)].emplace_back(gain, std::stoi(set.substr(bar + 1)));
  }
  std::set<int> kept;
  for (auto& [effect, gains] : by_effect) {
    std::sort(gains.rbegin(), gains.rend());
    // Something slower, which was not seen to repeat, leaves a trace in its neighbours.
    if (gains.front().second < fewest) continue;
    std::erase_if(gains, [fewest](const auto& one) { return one.second < fewest; });
    for (size_t i = 0; i < std::min(kKept, gains.size()); ++i) kept.insert(gains[i].second);
  }
  return {kept.begin(), kept.end()};
}

}  // namespace hydro::diagnose
