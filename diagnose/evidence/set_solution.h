// The amounts and variances that agree with each other under one set of changes: inside of SetEvidence.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "diagnose/evidence/set_evidence.h"

namespace hydro::diagnose {

// a: what is known beforehand of a group's variance is worth two numbers. It changes nothing where groups
// have tens.
inline constexpr double kVarianceShape = 1;

struct SetEvidence::Solution {
  std::vector<int> columns;  // of Rows::columns: those of every hypothesis, then those of the changes
  Eigen::VectorXd amounts;
  Eigen::VectorXd weights;  // at which the amounts are the best
  Eigen::VectorXd next;     // that the residuals of the amounts ask for
  Eigen::VectorXd squares, counted_squares;
  Eigen::LLT<Eigen::MatrixXd> normal;
  double penalty = 0;   // amounts' P^-1 amounts / 2 + ln|P A| / 2
  double jacobian = 0;  // of the torque balance, part of log E
};

}  // namespace hydro::diagnose
