#include "diagnose/evidence/set_weights.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "base/parallel.h"
#include "base/random.h"
#include "diagnose/fit/intervals.h"

namespace hydro::diagnose {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kDraws = 400;
// Most wrong answers are the truth plus a further change that slightly corrects the truth's form. Each change
// beyond the first must be worth this share of what there is to explain.
constexpr double kPriceOfAChange = 0.05;
// Large enough to include the truth.
constexpr size_t kFinalists = 25, kSubsetsOf = 3, kBestValues = 2;

// Those changes of a set that are missing terms, without variants.
ChangeSet NamedBy(const ChangeSet& set) {
  ChangeSet named = ChangesOf(set);
  std::erase_if(named, [](const std::string& name) { return !IsMissingTerm(name); });
  return named;
}

std::vector<ChangeSet> SubsetsOf(const ChangeSet& set) {
  std::vector<ChangeSet> subsets;
  for (size_t bits = 0; bits < size_t{1} << set.size(); ++bits) {
    ChangeSet& subset = subsets.emplace_back();
    for (size_t i = 0; i < set.size(); ++i)
      if (bits >> i & 1) subset.push_back(set[i]);
  }
  return subsets;
}

// The best sets, all subsets of the best three, the best of each named set, values, values of runs, and the
// empty set.
std::vector<ScoredSet> Finalists(SetScores* scores, bool curves) {
  std::vector<ScoredSet> tried = scores->BestFirst();
  if (!curves) std::erase_if(tried, [](const ScoredSet& one) { return HasCurve(one.set); });
  std::set<ChangeSet> chosen = {ChangeSet()};
  std::set<ChangeSet> named;
  std::map<std::string, size_t> singles;
  for (size_t i = 0; i < tried.size(); ++i) {
    const ChangeSet& set = tried[i].set;
    if (i < kFinalists) chosen.insert(set);
    if (i < kSubsetsOf)
      for (ChangeSet& subset : SubsetsOf(set)) chosen.insert(std::move(subset));
    if (named.size() < kFinalists && named.insert(NamedBy(set)).second) chosen.insert(set);
    if (set.size() == 1 && !IsMissingTerm(set.front()) &&
        singles[set.front().substr(0, set.front().find('.'))]++ < kBestValues)
      chosen.insert(set);
  }
  scores->Try({chosen.begin(), chosen.end()});
  std::vector<ScoredSet> finalists;
  for (ScoredSet& one : scores->BestFirst())
    if (chosen.contains(one.set)) finalists.push_back(std::move(one));
  return finalists;
}

// The log likelihood of each run (a row) under each finalist (a column).
MatrixXd LikelihoodsByRun(const SetScores& scores, const std::vector<ScoredSet>& finalists) {
  MatrixXd likelihoods(static_cast<Index>(scores.evidence().runs()), static_cast<Index>(finalists.size()));
  ParallelFor(finalists.size(), scores.jobs(), [&](size_t k) {
    const std::vector<double> by_run = scores.evidence().Fit(finalists[k].set).by_run;
    for (size_t r = 0; r < by_run.size(); ++r)
      likelihoods(static_cast<Index>(r), static_cast<Index>(k)) = by_run[r];
  });
  return likelihoods;
}

double ScoreOfNothing(const std::vector<ScoredSet>& finalists) {
  return std::ranges::find_if(finalists, [](const ScoredSet& one) { return one.set.empty(); })->score;
}

// The mean over draws of the finalists' shares exp(Z_k), with
//   Z_k = [S_k - ln pi_k + sum over runs (W_r - 1) l_kr - price (S_max - S_0) max(0, changes - 1)] / T
//         + ln pi_k.
// The odds pi are part of S and are not tempered. W_r is exponential with mean 1.
VectorXd DrawnShares(const SetScores& scores, const std::vector<ScoredSet>& finalists, uint64_t seed) {
  const auto count = static_cast<Index>(finalists.size());
  const double whole_gain = finalists.front().score - ScoreOfNothing(finalists);
  VectorXd fixed(count), odds(count);
  for (Index k = 0; k < count; ++k) {
    const ScoredSet& one = finalists[static_cast<size_t>(k)];
    odds[k] = scores.odds().LogOdds(one.set);
    const double further = std::max(0.0, static_cast<double>(one.set.size()) - 1);
    fixed[k] = one.score - odds[k] - kPriceOfAChange * whole_gain * further;
  }
  const MatrixXd likelihoods = LikelihoodsByRun(scores, finalists);
  // With a single run, the runs cannot contradict each other.
  const bool one_run = (likelihoods.array() != 0).rowwise().any().count() < 2;
  VectorXd shares = VectorXd::Zero(count);
  Random random(seed);
  for (int draw = 0; draw < kDraws; ++draw) {
    VectorXd counts(likelihoods.rows());
    for (double& one : counts) one = one_run ? 1.0 : -std::log(1 - random.Unit());
    VectorXd z = (fixed + likelihoods.transpose() * (counts.array() - 1).matrix()) / kTemperature + odds;
    z = (z.array() - z.maxCoeff()).exp();
    shares += z / z.sum() / kDraws;
  }
  return shares;
}

bool AddsTo(const ChangeSet& more, const ChangeSet& less) {
  return more.size() > less.size() && std::includes(more.begin(), more.end(), less.begin(), less.end());
}

// Adds the share of each set that scores less than a smaller one to the share of that smaller one, starting
// with the largest sets: only what gains something is a further change.
void DropAdditions(const std::vector<ScoredSet>& finalists, VectorXd* shares) {
  std::vector<size_t> order(finalists.size());
  std::vector<ChangeSet> changes;
  for (size_t k = 0; k < order.size(); ++k) {
    order[k] = k;
    changes.push_back(ChangesOf(finalists[k].set));
  }
  std::ranges::stable_sort(order, [&](size_t a, size_t b) { return changes[a].size() > changes[b].size(); });
  for (const size_t k : order)
    for (size_t j = 0; j < finalists.size(); ++j) {  // the best first
      if (!AddsTo(changes[k], changes[j])) continue;
      if (finalists[k].score < finalists[j].score) {
        (*shares)[static_cast<Index>(j)] += (*shares)[static_cast<Index>(k)];
        (*shares)[static_cast<Index>(k)] = 0;
      }
      break;
    }
}

}  // namespace

ExplanationWeights WeighExplanations(SetScores* scores, uint64_t seed, bool curves) {
  const std::vector<ScoredSet> finalists = Finalists(scores, curves);
  VectorXd shares = DrawnShares(*scores, finalists, seed);
  DropAdditions(finalists, &shares);
  std::map<ChangeSet, WeighedExplanation> by_changes;
  std::map<ChangeSet, double> largest;
  for (size_t k = 0; k < finalists.size(); ++k) {
    const double share = shares[static_cast<Index>(k)];
    if (share <= 0) continue;
    const ChangeSet changes = ChangesOf(finalists[k].set);
    WeighedExplanation& one = by_changes[changes];
    one.changes = changes;
    one.weight += share;
    if (share > largest[changes]) {
      largest[changes] = share;
      one.set = finalists[k].set;
    }
  }
  ExplanationWeights weights;
  for (auto& [changes, one] : by_changes) weights.explanations.push_back(std::move(one));
  weights.in_90 = SortByWeight(&weights.explanations);
  return weights;
}

}  // namespace hydro::diagnose
