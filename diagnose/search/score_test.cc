#include "diagnose/search/score_test.h"

#include <algorithm>
#include <cmath>

#include "maths/solve.h"

namespace hydro::diagnose {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// The furthest that a derivative alone may move a logarithm.
constexpr double kLongestStep = 1.5;

// The normal equations [A b; b' s] of all runs: the known parameters first, then the change's own.
struct NormalEquations {
  MatrixXd A;
  VectorXd b;
  double s = 0;
};

// Adds one run: `p` known parameters, then its start, are the columns of its basis. Its start is eliminated;
// the known parameters and the change's own remain.
void AddRun(const RunBasis& run, const RunColumns& columns, Index p, NormalEquations* all) {
  const VectorXd& values = columns.values;
  const MatrixXd& own = columns.own;
  const MatrixXd& basis = run.columns;
  const Index e = own.cols();
  const Index starts = basis.cols() - p;
  MatrixXd normal(p + starts + e, p + starts + e);
  normal.topLeftCorner(p + starts, p + starts) = run.normal;
  normal.topRightCorner(p + starts, e) = maths::TransposeTimes(basis, own);
  normal.bottomLeftCorner(e, p + starts) = normal.topRightCorner(p + starts, e).transpose();
  normal.bottomRightCorner(e, e) = maths::TransposeTimes(own, own);
  VectorXd right(p + starts + e);
  right << basis.transpose() * values, own.transpose() * values;
  if (!normal.allFinite() || !right.allFinite()) throw model::ModelError("its simulation is not finite");
  double sum = values.squaredNorm();
  if (starts > 0) {
    MatrixXd inner = normal.block(p, p, starts, starts);
    inner.diagonal().array() += 1e-10 * inner.diagonal().maxCoeff() + 1e-300;
    const MatrixXd across = normal.middleCols(p, starts);
    const VectorXd start_right = right.segment(p, starts);
    const VectorXd moved = maths::SolveSymmetric(inner, start_right);
    sum -= start_right.dot(moved);
    right -= across * moved;
    normal -= across * maths::SolveSymmetric(inner, across.transpose());
  }
  std::vector<Index> keep;
  for (Index i = 0; i < p + starts + e; ++i) {
    if (i < p || i >= p + starts) keep.push_back(i);
  }
  all->A += normal(keep, keep);
  all->b += right(keep);
  all->s += sum;
}

// The hypothesis with the change's own parameters moved; those known before stay.
Hypothesis Moved(const StartingPoint& point, const VectorXd& move, Index p) {
  std::vector<double> values;
  size_t next = 0;
  for (const FreeParameter& parameter : point.with.Free()) {
    if (next < point.own.size() && point.own[next].name == parameter.name) {
      values.push_back(parameter.Moved(move(p + static_cast<Index>(next++))));
    } else {
      values.push_back(parameter.value);
    }
  }
  Hypothesis moved = point.with;
  moved.Set(values);
  return moved;
}

}  // namespace

double BestMove(const MatrixXd& A, const VectorXd& b, double s, const VectorXd& low, const VectorXd& high,
                VectorXd* move) {
  const Index n = b.size();
  const Index own = low.size();
  VectorXd scale(n);
  for (Index i = 0; i < n; ++i) scale(i) = A(i, i) > 0 ? 1 / std::sqrt(A(i, i)) : 0;
  std::vector<bool> fixed(static_cast<size_t>(n), false);
  *move = VectorXd::Zero(n);
  for (Index round = 0; round <= own; ++round) {
    MatrixXd scaled = scale.asDiagonal() * A * scale.asDiagonal();
    VectorXd right = -(scale.asDiagonal() * (b + A * *move));
    for (Index i = 0; i < n; ++i) {
      scaled(i, i) += 1e-9;
      if (!fixed[static_cast<size_t>(i)] && scale(i) > 0) continue;
      scaled.row(i).setZero();
      scaled.col(i).setZero();
      scaled(i, i) = 1;
      right(i) = 0;
    }
    const VectorXd more = scale.asDiagonal() * maths::SolveSymmetric(scaled, right);
    *move += more;
    Index worst = -1;
    for (Index i = 0; i < own; ++i) {
      const Index at = n - own + i;
      if (fixed[static_cast<size_t>(at)]) continue;
      if ((*move)(at) < low(i) || (*move)(at) > high(i)) worst = at;
    }
    if (worst < 0) break;
    (*move)(worst) = std::clamp((*move)(worst), low(worst - (n - own)), high(worst - (n - own)));
    fixed[static_cast<size_t>(worst)] = true;
  }
  return s + 2 * b.dot(*move) + move->dot(A * *move);
}

Scanned ScoreTest(const std::vector<RunBasis>& bases, const std::vector<FreeParameter>& known,
                  const Prior& prior, const StartingPoint& point, const std::vector<RunColumns>& columns) {
  const auto p = static_cast<Index>(known.size());
  const auto e = static_cast<Index>(point.own.size());
  NormalEquations all{MatrixXd::Zero(p + e, p + e), VectorXd::Zero(p + e), 0};
  double before = 0;
  for (size_t r = 0; r < bases.size(); ++r) {
    AddRun(bases[r], columns[r], p, &all);
    before += bases[r].values.squaredNorm();
  }
  for (Index i = 0; i < p; ++i) {
    const auto place = static_cast<size_t>(i);
    all.A(i, i) += prior.weight[place];
    all.b(i) += prior.weight[place] * (known[place].ToFitted(known[place].value) - prior.centre[place]);
  }
  VectorXd low(e), high(e), move;
  for (Index i = 0; i < e; ++i) {
    const FreeParameter& parameter = point.own[static_cast<size_t>(i)];
    low(i) = parameter.logarithmic ? -kLongestStep : parameter.low - parameter.value;
    high(i) = parameter.logarithmic ? kLongestStep : parameter.high - parameter.value;
  }
  Scanned scanned;
  scanned.expected = before - BestMove(all.A, all.b, all.s, low, high, &move);
  scanned.start = Moved(point, move, p);
  return scanned;
}

}  // namespace hydro::diagnose
