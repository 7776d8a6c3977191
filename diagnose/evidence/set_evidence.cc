#include "diagnose/evidence/set_evidence.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>

#include "diagnose/evidence/set_solution.h"
#include "diagnose/fit/closure.h"

namespace hydro::diagnose {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

// The size of a change without a shape is known to an order of magnitude only: three and ten times the usual
// one are as many times rarer, so that the prior falls as the square of the size. With a normal distribution
// alone, a weight that is all of a motor's torque costs 50 nats, and a short recording cannot show it.
constexpr double kSizes[] = {3, 10};

// Whether the change is a curve or has a shape on a grid. Such a change at a wrong shape is large where the
// right one is not: with other sizes, a relief valve of 2850 psi that opens in eleven windows came out as one
// of 1400 psi that is nearly always open.
bool HasShape(const std::string& name) { return IsClosureEffect(name) || ChangeOf(name) != name; }

constexpr int kMostFromNothing = 25, kMostFromNull = 8;  // iterations between amounts and variances

}  // namespace

SetEvidence::SetEvidence(const Rows& rows)
    : SetEvidence(std::make_shared<const Grams>(GramsOf(rows)), std::vector<bool>()) {}

SetEvidence::SetEvidence(std::shared_ptr<const Grams> grams, std::vector<bool> left_out)
    : grams_(std::move(grams)), left_out_(std::move(left_out)) {
  left_out_.resize(grams_->runs, false);
  for (size_t i = 0; i < grams_->columns.size(); ++i)
    if (grams_->columns[i].set.empty()) always_.push_back(static_cast<int>(i));
  priors_ = std::make_shared<const Priors>(grams_->prior, always_);
  PlaceBlocks();
  FindNames();
  SolveNull();
}

SetEvidence SetEvidence::Without(const std::vector<size_t>& runs) const {
  std::vector<bool> left_out = left_out_;
  for (const size_t run : runs) left_out.at(run) = true;
  return SetEvidence(grams_, std::move(left_out));
}

void SetEvidence::PlaceBlocks() {
  Index groups = 0;
  for (const BlockGrams& grams : grams_->blocks) {
    if (left_out_[grams.run]) continue;
    PlacedBlock& block = blocks_.emplace_back(PlacedBlock{&grams, groups, {}});
    for (const int column : grams.always)
      block.always.push_back(std::ranges::lower_bound(always_, column) - always_.begin());
    groups += static_cast<Index>(grams.groups());
  }
  numbers_ = floor_ = inertia_share_ = VectorXd(groups);
  for (const PlacedBlock& block : blocks_) {
    const auto count = static_cast<Index>(block.grams->groups());
    numbers_.segment(block.first_group, count) = block.grams->numbers;
    floor_.segment(block.first_group, count) = block.grams->floor;
    inertia_share_.segment(block.first_group, count) = block.grams->inertia_share;
  }
}

void SetEvidence::FindNames() {
  std::map<std::string, std::vector<int>> columns;
  std::vector<bool> seen(grams_->columns.size(), false);
  for (const PlacedBlock& block : blocks_)
    for (size_t i = 0; i < block.grams->changes.size(); ++i) {
      const auto place = static_cast<Index>(block.always.size() + 1 + i);
      if (block.grams->products.col(PairAt(place, place)).maxCoeff() > 0)
        seen[static_cast<size_t>(block.grams->changes[i])] = true;
    }
  for (size_t i = 0; i < seen.size(); ++i)
    if (seen[i]) columns[grams_->columns[i].set].push_back(static_cast<int>(i));
  for (auto& [name, its] : columns) {
    names_.push_back(name);
    columns_of_names_.push_back(std::move(its));
  }
}

void SetEvidence::SolveNull() {
  const NormalEquations none(blocks_, static_cast<Index>(always_.size()), {});
  const VectorXd whole = none.Squares(VectorXd::Zero(none.size()));
  const VectorXd start = (floor_.array() + whole.array() / numbers_.array().max(1.0)).inverse();
  // The first solution has no Jacobian: only then is it known which part of the residuals is not the sensors'
  // noise.
  Solution null = Solve({}, {}, start, kMostFromNothing);
  VectorXd noise = none.NoiseSquares(null.amounts);
  if (!noise.size() || noise.maxCoeff() <= 0) noise = numbers_.cwiseProduct(floor_);
  const auto left = (null.squares + 2 * kVarianceShape * floor_).array();
  // What is left moves the shaft only as far as J w' reaches it: where a controller answers a disturbance, or
  // where the command itself was measured with noise, the shaft does not.
  const Eigen::ArrayXd moves = (InertiaSquares().array() / left).min(1.0);
  const Eigen::ArrayXd disturbs = (1 - noise.array() / left).max(0.0).min(1.0);
  inertia_numbers_ = (numbers_.array() * inertia_share_.array() * disturbs * moves).sum();
  if (inertia_numbers_ > 0) null = Solve({}, {}, start, kMostFromNothing);
  null_noise_ = none.NoiseSquares(null.amounts);
  null_squares_ = null.squares.cwiseMax(null_noise_) + 2 * kVarianceShape * floor_;
  start_weights_ = null.next;
}

// The squares of J w' in each group, by the model as given.
VectorXd SetEvidence::InertiaSquares() const {
  VectorXd squares = VectorXd::Zero(numbers_.size());
  for (const PlacedBlock& block : blocks_) {
    for (size_t i = 0; i < block.grams->always.size(); ++i) {
      if (!std::ranges::count(grams_->inertia, block.grams->always[i])) continue;
      const auto place = static_cast<Index>(i);
      squares.segment(block.first_group, static_cast<Index>(block.grams->groups())) +=
          block.grams->products.col(PairAt(place, place));
    }
  }
  return squares;
}

std::vector<int> SetEvidence::ColumnsOf(const ChangeSet& set) const {
  std::vector<int> columns;
  for (const std::string& name : set) {
    const auto at = std::ranges::lower_bound(names_, name);
    if (at == names_.end() || *at != name) throw std::out_of_range("the runs show no change '" + name + "'");
    const std::vector<int>& its = columns_of_names_[static_cast<size_t>(at - names_.begin())];
    columns.insert(columns.end(), its.begin(), its.end());
  }
  std::ranges::sort(columns);
  return columns;
}

bool SetEvidence::Shows(const ChangeSet& set) const {
  return std::ranges::all_of(
      set, [this](const std::string& name) { return std::ranges::binary_search(names_, name); });
}

double SetEvidence::Log(const ChangeSet& set) const { return LogOf(SolveFor(set)); }

SetFit SetEvidence::Fit(const ChangeSet& set) const {
  const Solution solution = SolveFor(set);
  SetFit fit;
  fit.log_evidence = LogOf(solution);
  fit.columns = solution.columns;
  fit.amounts = solution.amounts;
  fit.covariance = solution.normal.solve(Eigen::MatrixXd::Identity(fit.amounts.size(), fit.amounts.size()));
  fit.by_run.assign(runs(), 0.0);
  const VectorXd likelihoods = LogLikelihoods(solution);
  for (const PlacedBlock& block : blocks_)
    for (size_t k = 0; k < block.grams->groups(); ++k) {
      const Index g = block.first_group + static_cast<Index>(k);
      fit.groups.push_back({block.grams->balance, block.grams->run, block.grams->band[k], numbers_[g],
                            floor_[g], solution.weights[g], solution.squares[g],
                            solution.counted_squares[g]});
      fit.by_run[block.grams->run] += likelihoods[g];
    }
  return fit;
}

// The places of a change's columns among those of a set.
std::vector<Index> SetEvidence::PlacesOf(const std::string& name, const std::vector<int>& columns) const {
  std::vector<Index> places;
  for (size_t i = 0; i < columns.size(); ++i)
    if (grams_->columns[static_cast<size_t>(columns[i])].set == name) places.push_back(static_cast<Index>(i));
  return places;
}

SetEvidence::Solution SetEvidence::SolveFor(const ChangeSet& set) const {
  const std::vector<int> columns = ColumnsOf(set);
  const auto count = static_cast<Index>(columns.size());
  Solution best = Solve(columns, VectorXd::Ones(count), start_weights_, kMostFromNull);
  for (const std::string& name : set) {
    if (HasShape(name)) continue;
    const std::vector<Index> places = PlacesOf(name, columns);
    double squares = 0;
    for (const Index i : places) {
      const double sd = grams_->columns[static_cast<size_t>(columns[static_cast<size_t>(i)])].sd;
      squares += std::pow(best.amounts.tail(count)[i] / sd, 2);
    }
    if (squares <= static_cast<double>(places.size())) continue;  // the usual size, root mean square
    VectorXd scales = best.scales;
    const double log_size = best.log_size;
    for (const double size : kSizes) {
      scales(places).setConstant(size);
      Solution larger = Solve(columns, scales, start_weights_, kMostFromNull);
      larger.log_size = log_size - std::log(size);
      if (LogOf(larger) > LogOf(best)) best = std::move(larger);
    }
  }
  return best;
}

}  // namespace hydro::diagnose
