#include "tune/design/held_input.h"

#include <numeric>

#include "base/maths/matrix_functions.h"

namespace hydro::design {

using Eigen::Index;
using Eigen::MatrixXd;

HeldInput TransitionOver(const MatrixXd& A, const MatrixXd& B, double time) {
  const Index n = A.rows();
  MatrixXd both = MatrixXd::Zero(n + 1, n + 1);
  both.topLeftCorner(n, n) = A * time;
  both.topRightCorner(n, 1) = B * time;
  const MatrixXd exponential = maths::Exponential(both);
  return {exponential.topLeftCorner(n, n), exponential.topRightCorner(n, 1)};
}

std::vector<Index> StatesThatMatter(const MatrixXd& A, const MatrixXd& B, const MatrixXd& C) {
  std::vector<Index> kept(static_cast<size_t>(A.rows()));
  std::iota(kept.begin(), kept.end(), 0);
  const auto idle = [&](Index i) {
    bool moves = B(i, 0) != 0;
    bool matters = !C.col(i).isZero(0);
    for (const Index j : kept) {
      moves = moves || A(i, j) != 0;
      matters = matters || A(j, i) != 0;
    }
    return !moves || !matters;
  };
  while (std::erase_if(kept, idle) > 0) {
  }
  return kept;
}

}  // namespace hydro::design
