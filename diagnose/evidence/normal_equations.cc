#include "diagnose/evidence/normal_equations.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "model/terms/model_error.h"

namespace hydro::diagnose {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

PriorOfAmounts Inverted(const MatrixXd& covariance) {
  const Eigen::LLT<MatrixXd> factor(covariance);
  if (factor.info() != Eigen::Success)
    throw model::ModelError(
        "the model's values are beyond any machine's, or a signal is nothing throughout: nothing can be "
        "measured by them");
  return {factor.solve(MatrixXd::Identity(covariance.rows(), covariance.cols())),
          2 * factor.matrixLLT().diagonal().array().log().sum()};
}

}  // namespace

Priors::Priors(const MatrixXd& covariance, std::vector<int> always)
    : covariance_(covariance),
      always_(std::move(always)),
      of_always_(Inverted(covariance(always_, always_))) {}

PriorOfAmounts Priors::With(const std::vector<int>& changes, const VectorXd& scales) const {
  if (changes.empty()) return of_always_;
  // The inverse of a matrix in four parts, by the Schur complement of the part whose inverse is known.
  const MatrixXd across = covariance_(changes, always_);
  const MatrixXd regression = across * of_always_.precision;
  const MatrixXd own = scales.asDiagonal() * covariance_(changes, changes) * scales.asDiagonal();
  const PriorOfAmounts rest = Inverted(own - regression * across.transpose());
  const Index m = of_always_.precision.rows(), k = rest.precision.rows();
  PriorOfAmounts all{MatrixXd(m + k, m + k), of_always_.log_determinant + rest.log_determinant};
  const MatrixXd coupled = rest.precision * regression;
  all.precision.topLeftCorner(m, m) = of_always_.precision + regression.transpose() * coupled;
  all.precision.bottomLeftCorner(k, m) = -coupled;
  all.precision.topRightCorner(m, k) = -coupled.transpose();
  all.precision.bottomRightCorner(k, k) = rest.precision;
  return all;
}

NormalEquations::NormalEquations(const std::vector<PlacedBlock>& blocks, Index always,
                                 const std::vector<int>& changes)
    : blocks_(blocks), size_(always + static_cast<Index>(changes.size())) {
  for (const PlacedBlock& block : blocks) {
    std::vector<Placed>& placed = changes_.emplace_back();
    const std::vector<int>& own = block.grams->changes;
    for (size_t i = 0; i < changes.size(); ++i) {
      const auto at = std::ranges::lower_bound(own, changes[i]);
      if (at == own.end() || *at != changes[i]) continue;
      // y stands between the columns of every hypothesis and the others.
      placed.emplace_back(static_cast<Index>(block.always.size()) + 1 + (at - own.begin()),
                          always + static_cast<Index>(i));
    }
    groups_ += static_cast<Index>(block.grams->groups());
  }
}

void NormalEquations::Add(const VectorXd& weights, MatrixXd* normal, VectorXd* right) const {
  for (size_t b = 0; b < blocks_.size(); ++b) {
    const PlacedBlock& block = blocks_[b];
    const MatrixXd& products = block.grams->products;
    const auto m = static_cast<Index>(block.always.size());
    const auto w = weights.segment(block.first_group, products.rows());
    const VectorXd sums = products.leftCols(PairAt(0, m + 1)).transpose() * w;
    for (Index j = 0; j < m; ++j)
      for (Index i = 0; i <= j; ++i) (*normal)(block.always[j], block.always[i]) += sums[PairAt(i, j)];
    for (Index i = 0; i < m; ++i) (*right)[block.always[i]] -= sums[PairAt(i, m)];
    for (const auto& [place, at] : changes_[b]) {
      const VectorXd with = products.middleCols(PairAt(0, place), m + 1).transpose() * w;
      for (Index i = 0; i < m; ++i) (*normal)(at, block.always[i]) += with[i];
      (*right)[at] -= with[m];
      for (const auto& [other, other_at] : changes_[b])
        if (other <= place) (*normal)(at, other_at) += products.col(PairAt(other, place)).dot(w);
    }
  }
}

VectorXd NormalEquations::Squares(const VectorXd& amounts) const {
  return SquaresOf(&BlockGrams::products, amounts);
}

VectorXd NormalEquations::NoiseSquares(const VectorXd& amounts) const {
  return SquaresOf(&BlockGrams::noise, amounts);
}

VectorXd NormalEquations::SquaresOf(MatrixXd BlockGrams::*products, const VectorXd& amounts) const {
  VectorXd squares(groups_);
  for (size_t b = 0; b < blocks_.size(); ++b) {
    const PlacedBlock& block = blocks_[b];
    const MatrixXd& pairs = block.grams->*products;
    const auto m = static_cast<Index>(block.always.size());
    VectorXd factors(m + 1);
    for (Index i = 0; i < m; ++i) factors[i] = amounts[block.always[i]];
    factors[m] = 1;
    VectorXd of_pairs(PairAt(0, m + 1));  // pairs of different columns count twice
    for (Index j = 0; j <= m; ++j) {
      of_pairs.segment(PairAt(0, j), j + 1) = 2 * factors[j] * factors.head(j + 1);
      of_pairs[PairAt(j, j)] /= 2;
    }
    auto sum = squares.segment(block.first_group, pairs.rows());
    sum = pairs.leftCols(of_pairs.size()) * of_pairs;
    for (const auto& [place, at] : changes_[b]) {
      sum += pairs.middleCols(PairAt(0, place), m + 1) * (2 * amounts[at] * factors);
      for (const auto& [other, other_at] : changes_[b])
        if (other <= place)
          sum += (other < place ? 2 : 1) * amounts[at] * amounts[other_at] * pairs.col(PairAt(other, place));
    }
  }
  return squares.cwiseMax(0);
}

}  // namespace hydro::diagnose
