// The amounts and variances that agree with each other under one set of changes. Only SetEvidence uses it.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "diagnose/evidence/set_evidence.h"

namespace hydro::diagnose {

// a: the prior knowledge of a group's variance counts as two numbers. It makes no difference to groups with
// tens of numbers.
inline constexpr double kVarianceShape = 1;

struct SetEvidence::Solution {
  std::vector<int> columns;  // indices in Rows::columns: those of every hypothesis, then those of the changes
  Eigen::VectorXd amounts;
  Eigen::VectorXd weights;  // for which the amounts are the best
  Eigen::VectorXd next;     // that follow from the residuals of the amounts
  Eigen::VectorXd squares, counted_squares;
  Eigen::LLT<Eigen::MatrixXd> normal;
  Eigen::VectorXd scales;  // of the changes' amounts, see SolveFor()
  double log_size = 0;     // ln of the odds of these scales
  double penalty = 0;      // amounts' P^-1 amounts / 2 + ln|P A| / 2
  double jacobian = 0;     // of the torque balance, part of log E
};

}  // namespace hydro::diagnose
