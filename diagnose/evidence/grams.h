// What the evidence needs of the rows: for each group (balance, run, band of frequencies), the products of
// all pairs of columns, and the same products for what noise does to the rows.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnose/balances/rows.h"

namespace hydro::diagnose {

// The groups of one balance of one run. They have the same columns.
struct BlockGrams {
  BalanceKind balance = BalanceKind::kTorque;
  size_t run = 0;
  std::vector<int> band;  // of each group, increasing
  // Columns, as indices in Rows::columns: `always` are those of every hypothesis, `changes` those of sets of
  // changes, each increasing. In the order of the products, y stands between the two.
  std::vector<int> always, changes;
  // One row for each group. The product of the i-th and the j-th column, i <= j, is in column j (j + 1) / 2 +
  // i. Each row is weighted by its sensors' variance, see `floor`.
  Eigen::MatrixXd products;
  // The same products of the noise; 0 where the rows have none.
  Eigen::MatrixXd noise;
  Eigen::VectorXd numbers;  // how many independent numbers a group has
  // The mean over a group of the variance that a row has by what is known of the sensors and of the model. A
  // row whose own variance is larger by a factor counts less by that factor.
  Eigen::VectorXd floor;
  // The share of w' in the numbers of a torque balance. What a disturbance does to w' is counted through J.
  Eigen::VectorXd inertia_share;

  size_t groups() const { return band.size(); }
};

struct Grams {
  std::vector<ScanColumn> columns;
  Eigen::MatrixXd prior;           // covariance of all amounts
  std::vector<int> inertia;        // see Rows
  size_t runs = 0;                 // number of runs
  std::vector<BlockGrams> blocks;  // those with groups
};

// Computes the products of the rows. It leaves out groups that would only show how noise attenuates: those
// whose main column is not well above the sensors' noise, and those of one or two rows. Throws
// std::invalid_argument where sizes do not match or a number is not finite.
Grams GramsOf(const Rows& rows);

// The position of the i-th and the j-th column's product in BlockGrams::products, i <= j.
inline Eigen::Index PairAt(Eigen::Index i, Eigen::Index j) { return j * (j + 1) / 2 + i; }

}  // namespace hydro::diagnose
