#include "diagnose/fit/fit.h"

#include <ceres/ceres.h>
#include <ceres/normal_prior.h>
#include <glog/logging.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <memory>

#include "base/parallel.h"
#include "diagnose/fit/residuals.h"
#include "maths/solve.h"

namespace hydro::diagnose {

namespace {

using Eigen::Map;
using Eigen::MatrixXd;
using Eigen::VectorXd;

// One run against the hypothesis. The solver does not get the residuals, hundreds of thousands of them, but a
// square root of their normal equations: the same cost, gradient and Gauss-Newton matrix in a few numbers.
class RunCost : public ceres::CostFunction {
 public:
  RunCost(const Hypothesis& hypothesis, const RunData& run, const model::StartState& start)
      : hypothesis_(hypothesis),
        free_(hypothesis.Free()),
        run_(run),
        start_(start),
        starts_(StartUnknowns(run)) {
    if (!free_.empty()) mutable_parameter_block_sizes()->push_back(static_cast<int>(free_.size()));
    if (!starts_.empty()) mutable_parameter_block_sizes()->push_back(static_cast<int>(starts_.size()));
    set_num_residuals(static_cast<int>(unknowns()) + 1);
  }

  // Simulates at the point that the solver will ask for next.
  void Prepare(const double* free, const double* start, bool derivatives) {
    can_be_simulated_ = Normal(free, start, derivatives, &prepared_);
  }

  // Evaluates at the prepared point.
  bool Evaluate(double const* const* /*parameters*/, double* residuals, double** jacobians) const override {
    const auto p = static_cast<Eigen::Index>(free_.size());
    const auto n = static_cast<Eigen::Index>(unknowns());
    Map<VectorXd> out(residuals, n + 1);
    const MatrixXd& normal = prepared_;
    if (!can_be_simulated_ || (jacobians != nullptr && normal.rows() != n + 1)) return false;
    out.setZero();
    if (jacobians == nullptr) {
      out(0) = std::sqrt(normal(normal.rows() - 1, normal.rows() - 1));
      return true;
    }
    // [J r]' [J r] = V L V'; the rows of L^1/2 V' serve as well as those of [J r].
    const maths::SymmetricEigensystem eigen = maths::SymmetricEigensystemOf(normal);
    const MatrixXd root = eigen.values.cwiseMax(0.0).cwiseSqrt().asDiagonal() * eigen.vectors.transpose();
    out = root.col(n);
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    int block = 0;
    if (p > 0) {
      if (jacobians[block] != nullptr) Map<RowMajor>(jacobians[block], n + 1, p) = root.leftCols(p);
      ++block;
    }
    if (n > p && jacobians[block] != nullptr)
      Map<RowMajor>(jacobians[block], n + 1, n - p) = root.middleCols(p, n - p);
    return true;
  }

  // [J r]' [J r] at the point, or only r'r without derivatives.
  bool Normal(const double* free, const double* start, bool derivatives, MatrixXd* normal) const {
    Hypothesis point = hypothesis_;
    std::vector<FreeParameter> at = free_;
    std::vector<double> values;
    for (size_t i = 0; i < at.size(); ++i) values.push_back(at[i].value = at[i].FromFitted(free[i]));
    point.Set(values);
    model::StartState from = start_;
    for (size_t i = 0; i < starts_.size(); ++i) from[starts_[i].index] = start[i];
    Residuals r;
    try {
      r = derivatives ? ResidualsOf(point.model, run_, from, at, starts_)
                      : ResidualsOf(point.model, run_, from);
    } catch (const model::ModelError&) {
      return false;
    }
    const auto rows = static_cast<Eigen::Index>(r.values.size());
    const Map<const VectorXd> residual(r.values.data(), rows);
    if (!derivatives) {
      *normal = MatrixXd::Constant(1, 1, residual.squaredNorm());
      return std::isfinite((*normal)(0, 0));
    }
    const auto n = static_cast<Eigen::Index>(unknowns());
    const Map<const MatrixXd> jacobian(r.jacobian.data(), rows, n);
    normal->resize(n + 1, n + 1);
    normal->topLeftCorner(n, n).setZero();
    normal->topLeftCorner(n, n).selfadjointView<Eigen::Lower>().rankUpdate(jacobian.transpose());
    normal->topLeftCorner(n, n).triangularView<Eigen::Upper>() = normal->topLeftCorner(n, n).transpose();
    normal->topRightCorner(n, 1) = jacobian.transpose() * residual;
    normal->bottomLeftCorner(1, n) = normal->topRightCorner(n, 1).transpose();
    (*normal)(n, n) = residual.squaredNorm();
    count_ = r.values.size();
    return normal->allFinite();
  }

  size_t count() const { return count_; }
  const std::vector<model::Unknown>& starts() const { return starts_; }

 private:
  size_t unknowns() const { return free_.size() + starts_.size(); }

  const Hypothesis& hypothesis_;
  std::vector<FreeParameter> free_;
  const RunData& run_;
  model::StartState start_;
  std::vector<model::Unknown> starts_;
  mutable size_t count_ = 0;
  MatrixXd prepared_;
  bool can_be_simulated_ = false;
};

// Simulates all runs on several threads when the solver moves to another point. The solver itself uses one
// thread: with more it would add up the runs' costs in the order in which they finish, and round differently
// every time.
class AllRuns : public ceres::EvaluationCallback {
 public:
  AllRuns(const std::vector<double>& values, const std::vector<std::vector<double>>& starts, int jobs)
      : values_(values), starts_(starts), jobs_(jobs) {}
  void Add(RunCost* cost) { costs_.push_back(cost); }
  void PrepareForEvaluation(bool derivatives, bool /*new_point*/) override {
    ParallelFor(costs_.size(), jobs_,
                [&](size_t r) { costs_[r]->Prepare(values_.data(), starts_[r].data(), derivatives); });
  }

 private:
  const std::vector<double>& values_;
  const std::vector<std::vector<double>>& starts_;
  int jobs_;
  std::vector<RunCost*> costs_;
};

}  // namespace

std::vector<model::StartState> StartsOf(const Fitted& fitted) {
  std::vector<model::StartState> starts;
  starts.reserve(fitted.runs.size());
  for (const RunFit& run : fitted.runs) starts.push_back(run.start);
  return starts;
}

Fitted Fit(const Hypothesis& hypothesis, const std::vector<const RunData*>& runs,
           const std::vector<model::StartState>& starts, const FitOptions& options) {
  Fitted fitted;
  fitted.hypothesis = hypothesis;
  std::vector<FreeParameter> free = hypothesis.Free();
  std::vector<double> values;
  values.reserve(free.size());
  for (const FreeParameter& parameter : free) {
    values.push_back(parameter.ToFitted(std::clamp(parameter.value, parameter.low, parameter.high)));
  }
  std::vector<std::vector<double>> start_values(runs.size());
  std::vector<std::unique_ptr<RunCost>> costs;
  std::unique_ptr<ceres::CostFunction> prior;

  AllRuns all_runs(values, start_values, options.jobs);
  ceres::Problem::Options with_all_runs;
  // `costs` owns the cost functions: the problem would own only those added to it, and the cost of a run of
  // which nothing is free is not added.
  with_all_runs.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  with_all_runs.evaluation_callback = &all_runs;
  ceres::Problem problem(with_all_runs);
  for (size_t r = 0; r < runs.size(); ++r) {
    RunCost* const cost =
        costs.emplace_back(std::make_unique<RunCost>(hypothesis, *runs[r], starts[r])).get();
    all_runs.Add(cost);
    for (const model::Unknown& start : cost->starts()) start_values[r].push_back(starts[r][start.index]);
    std::vector<double*> blocks;
    if (!free.empty()) blocks.push_back(values.data());
    if (!start_values[r].empty()) blocks.push_back(start_values[r].data());
    if (blocks.empty()) continue;
    problem.AddResidualBlock(cost, nullptr, blocks);
  }
  for (size_t i = 0; i < free.size(); ++i) {
    const int place = static_cast<int>(i);
    if (std::isfinite(free[i].low)) {
      problem.SetParameterLowerBound(values.data(), place, free[i].ToFitted(free[i].low));
    }
    if (std::isfinite(free[i].high)) {
      problem.SetParameterUpperBound(values.data(), place, free[i].ToFitted(free[i].high));
    }
  }
  if (options.prior != nullptr && !free.empty()) {
    const Map<const VectorXd> centre(options.prior->centre.data(), static_cast<Eigen::Index>(free.size()));
    const Map<const VectorXd> weight(options.prior->weight.data(), static_cast<Eigen::Index>(free.size()));
    prior = std::make_unique<ceres::NormalPrior>(weight.cwiseSqrt().asDiagonal(), centre);
    problem.AddResidualBlock(prior.get(), nullptr, values.data());
  }
  FLAGS_minloglevel = google::GLOG_FATAL;  // a step that cannot be simulated is not an error
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_QR;
  solver.max_num_iterations = options.most_iterations;
  solver.function_tolerance = options.tolerance;
  solver.parameter_tolerance = 1e-7;
  solver.gradient_tolerance = 0;
  solver.num_threads = 1;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  if (summary.termination_type == ceres::FAILURE || summary.termination_type == ceres::USER_FAILURE) {
    fitted.failure = "its simulation fails";
    return fitted;
  }

  for (size_t i = 0; i < free.size(); ++i)
    values[i] = std::clamp(free[i].FromFitted(values[i]), free[i].low, free[i].high);
  fitted.hypothesis.Set(values);
  std::vector<double> at;
  for (size_t i = 0; i < free.size(); ++i) at.push_back(free[i].ToFitted(values[i]));
  const auto p = static_cast<Eigen::Index>(free.size());
  std::vector<MatrixXd> normals(runs.size());
  std::vector<char> simulated(runs.size());
  ParallelFor(runs.size(), options.jobs, [&](size_t r) {
    simulated[r] = costs[r]->Normal(at.data(), start_values[r].data(), true, &normals[r]);
  });
  for (size_t r = 0; r < runs.size(); ++r) {
    const MatrixXd& normal = normals[r];
    if (!simulated[r]) {
      fitted.failure = "its simulation fails";
      return fitted;
    }
    RunFit run;
    run.start = starts[r];
    for (size_t i = 0; i < costs[r]->starts().size(); ++i)
      run.start[costs[r]->starts()[i].index] = start_values[r][i];
    run.count = costs[r]->count();
    const Eigen::Index n = normal.rows() - 1;
    run.sum = normal(n, n);
    // The Schur complement of the start's block.
    MatrixXd information = normal.topLeftCorner(p, p);
    VectorXd gradient = normal.topRightCorner(p, 1);
    if (n > p && p > 0) {
      MatrixXd inner = normal.block(p, p, n - p, n - p);
      inner.diagonal().array() += 1e-12 * inner.diagonal().maxCoeff() + 1e-300;
      const Eigen::LDLT<MatrixXd> solve(inner);
      information -= normal.block(0, p, p, n - p) * solve.solve(normal.block(p, 0, n - p, p));
      gradient -= normal.block(0, p, p, n - p) * solve.solve(normal.block(p, n, n - p, 1));
    }
    run.information.assign(information.data(), information.data() + information.size());
    run.gradient.assign(gradient.data(), gradient.data() + gradient.size());
    fitted.sum += run.sum;
    fitted.count += run.count;
    fitted.runs.push_back(std::move(run));
  }
  return fitted;
}

}  // namespace hydro::diagnose
