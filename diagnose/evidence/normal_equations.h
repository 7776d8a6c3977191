// The normal equations of one set of changes, from the products of columns in groups of rows.
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "diagnose/evidence/grams.h"

namespace hydro::diagnose {

// What is known of the amounts before the runs are seen: a normal distribution with mean 0.
struct PriorOfAmounts {
  Eigen::MatrixXd precision;
  double log_determinant = 0;  // of the covariance
};

// The prior of the columns of every hypothesis. The prior of any set is made from it without a second
// inversion.
class Priors {
 public:
  // `always`: the columns of every hypothesis. Throws std::invalid_argument unless `covariance` is positive
  // definite.
  Priors(const Eigen::MatrixXd& covariance, std::vector<int> always);

  // The prior of the columns `always` followed by `changes`, whose standard deviations are multiplied by
  // `scales`, 1 or more each.
  PriorOfAmounts With(const std::vector<int>& changes, const Eigen::VectorXd& scales) const;

 private:
  Eigen::MatrixXd covariance_;  // of all columns
  std::vector<int> always_;
  PriorOfAmounts of_always_;
};

// The positions of a block's columns of every hypothesis among those of all blocks.
struct PlacedBlock {
  const BlockGrams* grams = nullptr;
  Eigen::Index first_group = 0;  // groups of all blocks are numbered consecutively
  std::vector<Eigen::Index> always;
};

// The normal equations of a set of changes. The amounts are those of the columns of every hypothesis,
// followed by those of the changes' columns.
class NormalEquations {
 public:
  // `always` is the number of columns in every hypothesis. `changes` lists columns, increasing. The blocks
  // must outlive this object.
  NormalEquations(const std::vector<PlacedBlock>& blocks, Eigen::Index always,
                  const std::vector<int>& changes);

  Eigen::Index size() const { return size_; }

  // Adds the sum over groups of weight X'X to the lower triangle of `normal`, and that of -weight X'y to
  // `right`.
  void Add(const Eigen::VectorXd& weights, Eigen::MatrixXd* normal, Eigen::VectorXd* right) const;

  // |y + X amounts|^2 of each group, 0 or more.
  Eigen::VectorXd Squares(const Eigen::VectorXd& amounts) const;

  // The same for what noise does to y + X amounts.
  Eigen::VectorXd NoiseSquares(const Eigen::VectorXd& amounts) const;

 private:
  // A column of the set in a block: its position among the block's columns, and among the amounts.
  using Placed = std::pair<Eigen::Index, Eigen::Index>;

  Eigen::VectorXd SquaresOf(Eigen::MatrixXd BlockGrams::*products, const Eigen::VectorXd& amounts) const;

  const std::vector<PlacedBlock>& blocks_;
  std::vector<std::vector<Placed>> changes_;  // by block
  Eigen::Index size_, groups_ = 0;
};

}  // namespace hydro::diagnose
