// The score test of one change: what it would gain, from the runs' derivatives at its starting point.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "diagnose/search/scan.h"

namespace hydro::diagnose {

// A run at the current fit: its derivatives with respect to the free numbers and the start.
struct RunBasis {
  Eigen::VectorXd values;  // residuals
  Eigen::MatrixXd columns;
  Eigen::MatrixXd normal;  // columns' columns
};

// What the score test of one change needs from one run.
struct RunColumns {
  Eigen::VectorXd values;  // the residuals with the change at its starting point
  Eigen::MatrixXd own;     // derivatives with respect to its parameters
};

// A change at one of its starting points.
struct StartingPoint {
  size_t change = 0;
  Hypothesis with;
  std::vector<FreeParameter> own;  // free in this hypothesis but not before
  bool moved = false;              // a base parameter that already has another value
};

// The best move d within the bounds for the normal equations [A b; b' s]: minimises s + 2 b'd + d'A d. `low`
// and `high` bound the last unknowns, as many as they have. Returns the minimum.
double BestMove(const Eigen::MatrixXd& A, const Eigen::VectorXd& b, double s, const Eigen::VectorXd& low,
                const Eigen::VectorXd& high, Eigen::VectorXd* move);

// The gain expected of a change, and the point to which its own parameters move for it. `prior`: of `known`,
// the parameters free before. Throws model::ModelError when derivatives are not finite.
Scanned ScoreTest(const std::vector<RunBasis>& bases, const std::vector<FreeParameter>& known,
                  const Prior& prior, const StartingPoint& point, const std::vector<RunColumns>& columns);

}  // namespace hydro::diagnose
