#include "diagnose/search/scan.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "base/parallel.h"
#include "diagnose/fit/residuals.h"
#include "maths/solve.h"
#include "model/terms/jet.h"

namespace hydro::diagnose {

namespace {

using Eigen::Index;
using Eigen::Map;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// The furthest that a derivative alone may move a logarithm.
constexpr double kLongestStep = 1.5;

// A run at the current fit: its derivatives with respect to the free numbers and the start.
struct RunBasis {
  VectorXd values;  // residuals
  MatrixXd columns;
  MatrixXd normal;  // columns' columns
};

// The best move d within the bounds for the normal equations [A b; b' s]: minimises s + 2 b'd + d'A d. `low`
// and `high` bound the last `own` unknowns. Returns the minimum.
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

// What the score test of one change needs from one run.
struct RunColumns {
  VectorXd values;  // the residuals with the change at its starting point
  MatrixXd own;     // derivatives with respect to its parameters
};

// A change at one of its starting points.
struct Task {
  size_t change = 0;
  Hypothesis with;
  std::vector<FreeParameter> own;  // free in this hypothesis but not before
  bool moved = false;              // a base parameter that already has another value
};

// The parameters at whose starting values a change does nothing: their derivatives are all there is to it.
// Empty for a change that acts already.
std::vector<size_t> Vanishing(const Task& task) {
  std::vector<size_t> places;
  if (task.moved) return places;
  for (size_t i = 0; i < task.own.size(); ++i) {
    const bool base = task.own[i].unknown.kind == model::Unknown::Kind::kBase;
    if (base || (task.own[i].value == 0 && !task.own[i].logarithmic)) places.push_back(i);
  }
  return places;
}

Scanned Judge(const std::vector<RunBasis>& bases, const std::vector<FreeParameter>& known, const Task& task,
              const std::vector<RunColumns>& columns) {
  Scanned scanned;
  const auto p = static_cast<Index>(known.size());
  const auto e = static_cast<Index>(task.own.size());
  MatrixXd A = MatrixXd::Zero(p + e, p + e);
  VectorXd b = VectorXd::Zero(p + e);
  double s = 0;
  double before = 0;
  for (size_t r = 0; r < bases.size(); ++r) {
    const VectorXd& values = columns[r].values;
    const MatrixXd& own = columns[r].own;
    const MatrixXd& basis = bases[r].columns;
    const Index starts = basis.cols() - p;
    MatrixXd normal(p + starts + e, p + starts + e);
    normal.topLeftCorner(p + starts, p + starts) = bases[r].normal;
    normal.topRightCorner(p + starts, e) = maths::TransposeTimes(basis, own);
    normal.bottomLeftCorner(e, p + starts) = normal.topRightCorner(p + starts, e).transpose();
    normal.bottomRightCorner(e, e) = maths::TransposeTimes(own, own);
    VectorXd right(p + starts + e);
    right << basis.transpose() * values, own.transpose() * values;
    if (!normal.allFinite() || !right.allFinite()) throw model::ModelError("its simulation is not finite");
    // Eliminates the run's start; the known parameters and the change's own remain.
    std::vector<Index> keep;
    for (Index i = 0; i < p + starts + e; ++i) {
      if (i < p || i >= p + starts) keep.push_back(i);
    }
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
    A += normal(keep, keep);
    b += right(keep);
    s += sum;
    before += bases[r].values.squaredNorm();
  }
  VectorXd low(e), high(e), move;
  for (Index i = 0; i < e; ++i) {
    const FreeParameter& parameter = task.own[static_cast<size_t>(i)];
    low(i) = parameter.logarithmic ? -kLongestStep : parameter.low - parameter.value;
    high(i) = parameter.logarithmic ? kLongestStep : parameter.high - parameter.value;
  }
  const double after = BestMove(A, b, s, low, high, &move);
  scanned.expected = before - after;
  std::vector<double> values;
  size_t next = 0;
  for (const FreeParameter& parameter : task.with.Free()) {
    if (next < task.own.size() && task.own[next].name == parameter.name) {
      values.push_back(parameter.Moved(move(p + static_cast<Index>(next++))));
    } else {
      values.push_back(parameter.value);
    }
  }
  scanned.start = task.with;
  scanned.start.Set(values);
  return scanned;
}

// A change that already acts at its starting point gets a simulation of its own.
std::vector<RunColumns> Alone(const Fitted& current, const std::vector<const RunData*>& runs,
                              const Task& task) {
  std::vector<RunColumns> columns(runs.size());
  for (size_t r = 0; r < runs.size(); ++r) {
    const Residuals residuals = ResidualsOf(task.with.model, *runs[r], current.runs[r].start, task.own, {});
    const auto rows = static_cast<Index>(residuals.values.size());
    columns[r].values = Map<const VectorXd>(residuals.values.data(), rows);
    columns[r].own =
        Map<const MatrixXd>(residuals.jacobian.data(), rows, static_cast<Index>(task.own.size()));
  }
  return columns;
}

// Changes that do nothing yet share one simulation; `columns` gets the results by task. False if they turn
// out to do something after all.
bool Together(const Fitted& current, const std::vector<const RunData*>& runs,
              const std::vector<RunBasis>& bases, const std::vector<const Task*>& tasks,
              std::vector<std::vector<RunColumns>>* columns) {
  model::ModelDescription model = current.hypothesis.model;
  for (const Task* task : tasks) {
    if (task->own.front().unknown.kind == model::Unknown::Kind::kEffect) {
      model.effects.push_back(task->with.model.effects.back());
    }
  }
  // Where each task's parameters are in the common model, which orders effects by their ids.
  const std::vector<model::EffectParameter> all = model::EffectParameters(model);
  std::vector<FreeParameter> vanishing;
  size_t effect = current.hypothesis.model.effects.size();
  for (const Task* task : tasks) {
    const bool adds = task->own.front().unknown.kind == model::Unknown::Kind::kEffect;
    for (const size_t place : Vanishing(*task)) {
      FreeParameter& parameter = vanishing.emplace_back(task->own[place]);
      for (size_t i = 0; adds && i < all.size(); ++i) {
        if (all[i].effect == effect && model.effects[effect].id + "." + all[i].name == parameter.name) {
          parameter.unknown.index = i;
        }
      }
    }
    if (adds) ++effect;
  }
  columns->assign(tasks.size(), std::vector<RunColumns>(runs.size()));
  for (size_t r = 0; r < runs.size(); ++r) {
    const Residuals residuals = ResidualsOf(model, *runs[r], current.runs[r].start, vanishing, {}, true);
    const auto rows = static_cast<Index>(residuals.values.size());
    const Map<const VectorXd> values(residuals.values.data(), rows);
    if (!((values - bases[r].values).squaredNorm() < 1e-4 * static_cast<double>(rows))) return false;
    const Map<const MatrixXd> jacobian(residuals.jacobian.data(), rows, static_cast<Index>(vanishing.size()));
    Index next = 0;
    for (size_t t = 0; t < tasks.size(); ++t) {
      RunColumns& own = (*columns)[t][r];
      own.values = bases[r].values;
      own.own = MatrixXd::Zero(rows, static_cast<Index>(tasks[t]->own.size()));
      for (const size_t place : Vanishing(*tasks[t])) {
        own.own.col(static_cast<Index>(place)) = jacobian.col(next++);
      }
    }
  }
  return true;
}

}  // namespace

std::vector<std::vector<Scanned>> Scan(const Fitted& current, const std::vector<const RunData*>& runs,
                                       const std::vector<Change>& changes, const Sizes& sizes, bool elsewhere,
                                       int jobs) {
  const std::vector<FreeParameter> known = current.hypothesis.Free();
  std::vector<RunBasis> bases(runs.size());
  ParallelFor(runs.size(), jobs, [&](size_t r) {
    const std::vector<model::Unknown> starts = StartUnknowns(*runs[r]);
    const Residuals residuals =
        ResidualsOf(current.hypothesis.model, *runs[r], current.runs[r].start, known, starts);
    const auto rows = static_cast<Index>(residuals.values.size());
    bases[r].columns = Map<const MatrixXd>(residuals.jacobian.data(), rows,
                                           static_cast<Index>(known.size() + starts.size()));
    bases[r].normal = maths::TransposeTimes(bases[r].columns, bases[r].columns);
    bases[r].values = Map<const VectorXd>(residuals.values.data(), rows);
  });

  std::vector<Task> tasks;
  for (size_t c = 0; c < changes.size(); ++c) {
    for (Hypothesis& with : With(current.hypothesis, changes[c], sizes, elsewhere)) {
      Task task{c, std::move(with), {}, false};
      for (const FreeParameter& parameter : task.with.Free()) {
        const bool had = std::any_of(known.begin(), known.end(), [&](const FreeParameter& other) {
          return other.name == parameter.name;
        });
        if (!had) task.own.push_back(parameter);
        task.moved |= !had && parameter.unknown.kind == model::Unknown::Kind::kBase &&
                      parameter.value != current.hypothesis.model.parameters.*
                                             model::BaseParameters()[parameter.unknown.index].member;
      }
      tasks.push_back(std::move(task));
    }
  }
  // Changes that do nothing at their starting point share simulations, as many as fit the directions of one
  // pass.
  std::vector<std::vector<size_t>> groups;
  std::vector<size_t> single;
  size_t directions = 0;
  for (size_t t = 0; t < tasks.size(); ++t) {
    const size_t own = Vanishing(tasks[t]).size();
    if (own == 0) {
      single.push_back(t);
      continue;
    }
    if (groups.empty() || directions + own > static_cast<size_t>(model::kJetWidth)) {
      groups.emplace_back();
      directions = 0;
    }
    groups.back().push_back(t);
    directions += own;
  }
  std::vector<Scanned> judged(tasks.size());
  const auto alone = [&](size_t t) {
    try {
      judged[t] = Judge(bases, known, tasks[t], Alone(current, runs, tasks[t]));
    } catch (const model::ModelError& error) {
      judged[t].failure = error.what();
      judged[t].start = tasks[t].with;
    }
  };
  ParallelFor(groups.size() + single.size(), jobs, [&](size_t i) {
    if (i >= groups.size()) return alone(single[i - groups.size()]);
    std::vector<const Task*> members;
    for (const size_t t : groups[i]) members.push_back(&tasks[t]);
    std::vector<std::vector<RunColumns>> columns;
    bool together = false;
    try {
      together = Together(current, runs, bases, members, &columns);
      for (size_t m = 0; together && m < members.size(); ++m) {
        judged[groups[i][m]] = Judge(bases, known, *members[m], columns[m]);
      }
    } catch (const model::ModelError&) {
      together = false;  // one of them cannot be simulated; trying each alone shows which
    }
    if (!together) {
      for (const size_t t : groups[i]) alone(t);
    }
  });
  std::vector<std::vector<Scanned>> scanned(changes.size());
  for (size_t t = 0; t < tasks.size(); ++t) {
    judged[t].change = changes[tasks[t].change];
    scanned[tasks[t].change].push_back(std::move(judged[t]));
  }
  for (auto& rows : scanned) {
    std::stable_sort(rows.begin(), rows.end(),
                     [](const Scanned& a, const Scanned& b) { return a.expected > b.expected; });
  }
  return scanned;
}

}  // namespace hydro::diagnose
