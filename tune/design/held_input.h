#pragma once

#include <Eigen/Core>
#include <vector>

// A linear system x' = A x + B u whose input is held between samples, as a digital-to-analog converter holds
// it.
namespace hydro::design {

struct HeldInput {
  Eigen::MatrixXd states;  // x(t + time) = states x(t) + input u
  Eigen::VectorXd input;
};

// The exact transition over `time` seconds. A is n x n, B is n x 1.
HeldInput TransitionOver(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B, double time);

// The indices of the states that change and on which an output (row of C) depends.
std::vector<Eigen::Index> StatesThatMatter(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B,
                                           const Eigen::MatrixXd& C);

}  // namespace hydro::design
