#include "diagnose/scan.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "diagnose/parallel.h"
#include "diagnose/residuals.h"

namespace hydro {

namespace {

using Eigen::Index;
using Eigen::Map;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// No logarithm is moved further than this by a derivative alone.
constexpr double kLongestStep = 1.5;

// A run at the current fit: derivatives by its free numbers and its start.
struct RunBasis {
  MatrixXd columns;
  double sum = 0;
};

// The best move within the bounds, for the normal equations [A b; b' s]: s + 2 b'd + d'A d. The last `own` of
// the unknowns are bounded, by `low` and `high`. Returns the least value.
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
    const VectorXd more = scale.asDiagonal() * scaled.ldlt().solve(right);
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

Scanned Judge(const Fitted& current, const std::vector<const RunData*>& runs,
              const std::vector<RunBasis>& bases, const std::vector<FreeParameter>& known,
              const Change& change, Hypothesis with, size_t stride) {
  Scanned scanned;
  scanned.change = change;
  const std::vector<FreeParameter> all = with.Free();
  std::vector<FreeParameter> own;
  std::vector<Unknown> unknowns;
  for (const FreeParameter& parameter : all) {
    const bool had = std::any_of(known.begin(), known.end(),
                                 [&](const FreeParameter& other) { return other.name == parameter.name; });
    if (had) continue;
    own.push_back(parameter);
    unknowns.push_back(parameter.unknown);
  }
  const auto p = static_cast<Index>(known.size());
  const auto e = static_cast<Index>(own.size());
  MatrixXd A = MatrixXd::Zero(p + e, p + e);
  VectorXd b = VectorXd::Zero(p + e);
  double s = 0;
  double before = 0;
  try {
    for (size_t r = 0; r < runs.size(); ++r) {
      Residuals residuals = ResidualsOf(with.model, *runs[r], current.runs[r].start, unknowns, stride);
      const auto rows = static_cast<Index>(residuals.values.size());
      const Map<const VectorXd> values(residuals.values.data(), rows);
      Map<MatrixXd> jacobian(residuals.jacobian.data(), rows, e);
      for (Index i = 0; i < e; ++i) {
        if (own[static_cast<size_t>(i)].logarithmic) jacobian.col(i) *= own[static_cast<size_t>(i)].value;
      }
      const MatrixXd& basis = bases[r].columns;
      const Index starts = basis.cols() - p;
      MatrixXd normal(p + starts + e, p + starts + e);
      normal.topLeftCorner(p + starts, p + starts) = basis.transpose() * basis;
      normal.topRightCorner(p + starts, e) = basis.transpose() * jacobian;
      normal.bottomLeftCorner(e, p + starts) = normal.topRightCorner(p + starts, e).transpose();
      normal.bottomRightCorner(e, e) = jacobian.transpose() * jacobian;
      VectorXd right(p + starts + e);
      right << basis.transpose() * values, jacobian.transpose() * values;
      if (!normal.allFinite() || !right.allFinite()) throw ModelError("not finite");
      // The run's start is taken out; what is left are the known parameters and the change's own.
      std::vector<Index> keep;
      for (Index i = 0; i < p + starts + e; ++i) {
        if (i < p || i >= p + starts) keep.push_back(i);
      }
      double sum = values.squaredNorm();
      if (starts > 0) {
        MatrixXd inner = normal.block(p, p, starts, starts);
        inner.diagonal().array() += 1e-10 * inner.diagonal().maxCoeff() + 1e-300;
        const Eigen::LDLT<MatrixXd> solve(inner);
        const MatrixXd across = normal.middleCols(p, starts);
        const VectorXd start_right = right.segment(p, starts);
        const VectorXd moved = solve.solve(start_right);
        sum -= start_right.dot(moved);
        right -= across * moved;
        normal -= across * solve.solve(across.transpose());
      }
      A += normal(keep, keep);
      b += right(keep);
      s += sum;
      before += bases[r].sum;
    }
  } catch (const ModelError& error) {
    scanned.failure = error.what();
    scanned.start = std::move(with);
    return scanned;
  }
  VectorXd low(e), high(e), move;
  for (Index i = 0; i < e; ++i) {
    const FreeParameter& parameter = own[static_cast<size_t>(i)];
    low(i) = parameter.logarithmic ? -kLongestStep : parameter.low - parameter.value;
    high(i) = parameter.logarithmic ? kLongestStep : parameter.high - parameter.value;
  }
  const double after = BestMove(A, b, s, low, high, &move);
  scanned.expected = (before - after) * static_cast<double>(stride);
  std::vector<double> values;
  size_t next = 0;
  for (const FreeParameter& parameter : all) {
    if (next < own.size() && own[next].name == parameter.name) {
      const double moved = move(p + static_cast<Index>(next++));
      values.push_back(parameter.logarithmic ? parameter.value * std::exp(moved) : parameter.value + moved);
    } else {
      values.push_back(parameter.value);
    }
  }
  with.Set(values);
  scanned.start = std::move(with);
  return scanned;
}

}  // namespace

std::vector<std::vector<Scanned>> Scan(const Fitted& current, const std::vector<const RunData*>& runs,
                                       const std::vector<Change>& changes, const Sizes& sizes, size_t stride,
                                       int jobs) {
  const std::vector<FreeParameter> known = current.hypothesis.Free();
  std::vector<RunBasis> bases(runs.size());
  ParallelFor(runs.size(), jobs, [&](size_t r) {
    std::vector<Unknown> unknowns;
    for (const FreeParameter& parameter : known) unknowns.push_back(parameter.unknown);
    for (const Unknown& start : StartUnknowns(*runs[r])) unknowns.push_back(start);
    const Residuals residuals =
        ResidualsOf(current.hypothesis.model, *runs[r], current.runs[r].start, unknowns, stride);
    const auto rows = static_cast<Index>(residuals.values.size());
    bases[r].columns =
        Map<const MatrixXd>(residuals.jacobian.data(), rows, static_cast<Index>(unknowns.size()));
    for (size_t i = 0; i < known.size(); ++i) {
      if (known[i].logarithmic) bases[r].columns.col(static_cast<Index>(i)) *= known[i].value;
    }
    bases[r].sum = Map<const VectorXd>(residuals.values.data(), rows).squaredNorm();
  });

  struct Task {
    size_t change;
    Hypothesis with;
  };
  std::vector<Task> tasks;
  for (size_t c = 0; c < changes.size(); ++c) {
    for (Hypothesis& with : With(current.hypothesis, changes[c], sizes))
      tasks.push_back({c, std::move(with)});
  }
  std::vector<Scanned> judged(tasks.size());
  ParallelFor(tasks.size(), jobs, [&](size_t t) {
    judged[t] = Judge(current, runs, bases, known, changes[tasks[t].change], tasks[t].with, stride);
  });
  std::vector<std::vector<Scanned>> scanned(changes.size());
  for (size_t t = 0; t < tasks.size(); ++t) scanned[tasks[t].change].push_back(std::move(judged[t]));
  for (auto& rows : scanned) {
    std::stable_sort(rows.begin(), rows.end(),
                     [](const Scanned& a, const Scanned& b) { return a.expected > b.expected; });
  }
  return scanned;
}

}  // namespace hydro
