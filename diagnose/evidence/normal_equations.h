// The normal equations of one set of changes, from the products of columns in groups of rows.
#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "diagnose/evidence/grams.h"

namespace hydro::diagnose {

// What is known of the amounts before the runs are seen: normal, mean 0.
struct PriorOfAmounts {
  Eigen::MatrixXd precision;
  double log_determinant = 0;  // of the covariance
};

// The prior of the columns of every hypothesis, from which that of any set is made without inverting it again.
class Priors {
 public:
  // `always`: the columns of every hypothesis. Throws std::invalid_argument unless `covariance` is positive
  // definite.
  Priors(const Eigen::MatrixXd& covariance, std::vector<int> always);

  // Of the columns `always`, then `changes`.
  PriorOfAmounts With(const std::vector<int>& changes) const;

 private:
  Eigen::MatrixXd covariance_;  // of all columns
  std::vector<int> always_;
  PriorOfAmounts of_always_;
};

// Where the columns of every hypothesis of a block are among those of all blocks.
struct PlacedBlock {
  const BlockGrams* grams = nullptr;
  Eigen::Index first_group = 0;  // groups of all blocks are numbered one after the other
  std::vector<Eigen::Index> always;
};

// A set of changes: amounts are those of the columns of every hypothesis, then those of the changes' columns.
class NormalEquations {
 public:
  // `always`: how many columns are in every hypothesis. `changes`: columns, increasing. The blocks must
  // outlive this.
  NormalEquations(const std::vector<PlacedBlock>& blocks, Eigen::Index always,
                  const std::vector<int>& changes);

  Eigen::Index size() const { return size_; }

  // Adds the sum over groups of weight X'X to `normal`, its lower triangle only, and of -weight X'y to `right`.
  void Add(const Eigen::VectorXd& weights, Eigen::MatrixXd* normal, Eigen::VectorXd* right) const;

  // |y + X amounts|^2 of each group, 0 or more.
  Eigen::VectorXd Squares(const Eigen::VectorXd& amounts) const;

  // The same of what noise does to y + X amounts.
  Eigen::VectorXd NoiseSquares(const Eigen::VectorXd& amounts) const;

 private:
  // A column of the set in a block: where it is among the block's, and among the amounts.
  using Placed = std::pair<Eigen::Index, Eigen::Index>;

  Eigen::VectorXd SquaresOf(Eigen::MatrixXd BlockGrams::*products, const Eigen::VectorXd& amounts) const;

  const std::vector<PlacedBlock>& blocks_;
  std::vector<std::vector<Placed>> changes_;  // by block
  Eigen::Index size_, groups_ = 0;
};

}  // namespace hydro::diagnose
