// What the evidence needs of the rows: for each group (balance, run, band of frequencies) the products of all
// pairs of columns, of the rows and of what noise does to them.
#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "diagnose/balances/rows.h"

namespace hydro::diagnose {

// The groups of one balance of one run: they have the same columns.
struct BlockGrams {
  BalanceKind balance = BalanceKind::kTorque;
  size_t run = 0;
  std::vector<int> band;  // of each group, increasing
  // Columns, among Rows::columns: those of every hypothesis, increasing; then those of sets of changes,
  // increasing. In the order of the products y stands between them.
  std::vector<int> always, changes;
  // A row for each group. The product of the i-th and the j-th column, i <= j, is in column j (j + 1) / 2 +
  // i. Rows count as much as their sensors' variance lets them, see `floor`.
  Eigen::MatrixXd products;
  // The same of the noise; 0 where the rows have none.
  Eigen::MatrixXd noise;
  Eigen::VectorXd numbers;  // how many independent numbers a group is
  // Variance of a row from what is known of the sensors and of the model, the mean of a group. A row whose
  // own is larger by a factor counts less by that factor.
  Eigen::VectorXd floor;
  // The share of w' in the numbers of a torque balance: what a disturbance changes w' by is J's to answer for.
  Eigen::VectorXd inertia_share;

  size_t groups() const { return band.size(); }
};

struct Grams {
  std::vector<ScanColumn> columns;
  Eigen::MatrixXd prior;           // covariance of all amounts
  std::vector<int> inertia;        // see Rows
  size_t runs = 0;                 // how many there are
  std::vector<BlockGrams> blocks;  // those with groups
};

// The products of the rows. Groups that would teach nothing but how noise attenuates are left out: those
// whose main column is not well above the sensors' noise, and those of two rows or one. Throws
// std::invalid_argument where sizes do not match and where a number is not finite.
Grams GramsOf(const Rows& rows);

// Where the pair of the i-th and the j-th column is in BlockGrams::products, i <= j.
inline Eigen::Index PairAt(Eigen::Index i, Eigen::Index j) { return j * (j + 1) / 2 + i; }

}  // namespace hydro::diagnose
