// The log evidence of any set of changes, from the balances' rows: nothing is simulated.
//
// Each group g of rows (balance, run, band of frequencies) has a variance of its own. It is integrated over
// an inverse-gamma prior (a, b_g), where b_g = a f_g and f_g is the variance that is known beforehand:
//   log E = -sum_g (a + n_g / 2) ln((b_g + RSS_g / 2) / f_g) - amounts' P^-1 amounts / 2 - ln|P A| / 2
// This holds at the amounts and variances that agree with each other. Corrections are made for noise in the
// columns, for the Jacobian where a disturbance moves the shaft, and for amounts that cannot be negative.
// A change that is no curve and has no shape on a grid may be three or ten times as large as usual, at odds
// of 1/3 and 1/10.
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "diagnose/evidence/change_set.h"
#include "diagnose/evidence/grams.h"
#include "diagnose/evidence/normal_equations.h"

namespace hydro::diagnose {

// One group of rows under a set of changes.
struct GroupFit {
  BalanceKind balance = BalanceKind::kTorque;
  size_t run = 0;
  int band = 0;
  double numbers = 0;          // n: independent numbers
  double floor = 0;            // f: variance of one number that is known beforehand
  double weight = 0;           // 1 / variance for which the amounts are the best
  double squares = 0;          // of the residuals
  double counted_squares = 0;  // RSS: the same, corrected for the noise in the columns
};

struct SetFit {
  double log_evidence = 0;
  std::vector<int> columns;  // of Rows::columns; those of every hypothesis first
  Eigen::VectorXd amounts;
  Eigen::MatrixXd covariance;  // of the amounts
  std::vector<GroupFit> groups;
  std::vector<double> by_run;  // log likelihood of each run: the part of log E from its groups
};

class SetEvidence {
 public:
  // Uses all runs. Throws as GramsOf() does.
  explicit SetEvidence(const Rows& rows);

  // The same evidence without these runs.
  SetEvidence Without(const std::vector<size_t>& runs) const;

  // Sorted names of the changes that the runs can show: at least one of their columns is not zero.
  const std::vector<std::string>& names() const { return names_; }
  // Whether all changes of the set are among names(). At another shape, or without a run, an effect may act
  // nowhere.
  bool Shows(const ChangeSet& set) const;

  // The number of runs, including those left out.
  size_t runs() const { return grams_->runs; }

  // The log evidence. Throws std::out_of_range where a name is not among names().
  double Log(const ChangeSet& set) const;
  SetFit Fit(const ChangeSet& set) const;

 private:
  struct Solution;  // set_solution.h

  SetEvidence(std::shared_ptr<const Grams> grams, std::vector<bool> left_out);
  void PlaceBlocks();
  void FindNames();
  void SolveNull();
  Eigen::VectorXd InertiaSquares() const;

  std::vector<int> ColumnsOf(const ChangeSet& set) const;
  std::vector<Eigen::Index> PlacesOf(const std::string& name, const std::vector<int>& columns) const;
  // With the likeliest size of each change without a shape whose amounts are beyond the usual one.
  Solution SolveFor(const ChangeSet& set) const;
  // Iterates between amounts and variances, starting from `weights`, at most `most` times. `scales`: factors
  // on the standard deviations of the changes' amounts.
  Solution Solve(const std::vector<int>& changes, const Eigen::VectorXd& scales, Eigen::VectorXd weights,
                 int most) const;
  void AddJacobian(const std::vector<Eigen::Index>& inertia, const Eigen::VectorXd& amounts,
                   Eigen::MatrixXd* normal, Eigen::VectorXd* right) const;
  Eigen::VectorXd NoiseFactors(const Eigen::VectorXd& passed) const;
  Eigen::VectorXd LogLikelihoods(const Solution& solution) const;  // by group
  double PriceOfFalls(const Solution& solution) const;
  double DeviationAt(const Solution& solution, Eigen::Index at) const;
  double LogOf(const Solution& solution) const;

  std::shared_ptr<const Grams> grams_;
  std::vector<bool> left_out_;
  std::vector<PlacedBlock> blocks_;
  std::vector<int> always_;
  std::shared_ptr<const Priors> priors_;
  std::vector<std::string> names_;
  std::vector<std::vector<int>> columns_of_names_;
  Eigen::VectorXd numbers_, floor_, inertia_share_;  // by group
  // From the fit without changes.
  Eigen::VectorXd start_weights_, null_noise_, null_squares_;
  double inertia_numbers_ = 0;  // how many numbers count in the Jacobian of the torque balance
};

}  // namespace hydro::diagnose
