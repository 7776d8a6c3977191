#include "diagnose/fit/fit.h"

#include <ceres/ceres.h>
#include <ceres/normal_prior.h>
#include <glog/logging.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <memory>

#include "base/maths/matrix_functions.h"
#include "base/parallel.h"
#include "diagnose/fit/run_cost.h"
#include "diagnose/fit/turn.h"

namespace hydro::diagnose {
namespace {

// With more runs than this, the solver eliminates their starts first.
constexpr size_t kFewRuns = 8;

using Eigen::Map;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr char kCannotBeSimulated[] = "its simulation fails";

// Simulates all runs on several threads when the solver moves to another point. The solver itself uses one
// thread: with several, it would add the runs' costs in the order in which they finish, and round differently
// each time.
class AllRuns : public ceres::EvaluationCallback {
 public:
  AllRuns(const std::vector<double>& values, const std::vector<model::StartState>& starts, int jobs)
      : values_(values), starts_(starts), jobs_(jobs) {}
  void Add(RunCost* cost) { costs_.push_back(cost); }
  void PrepareForEvaluation(bool derivatives, bool /*new_point*/) override {
    ParallelFor(costs_.size(), jobs_,
                [&](size_t r) { costs_[r]->Prepare(values_.data(), starts_[r].data(), derivatives); });
  }

 private:
  const std::vector<double>& values_;
  const std::vector<model::StartState>& starts_;
  int jobs_;
  std::vector<RunCost*> costs_;
};

// Eliminates the run's start, which forms the last unknowns after `p` free parameters, from its normal
// equations, by the Schur complement of the start's block.
void EliminateStart(const MatrixXd& normal, Eigen::Index p, RunFit* run) {
  const Eigen::Index n = normal.rows() - 1;
  MatrixXd information = normal.topLeftCorner(p, p);
  VectorXd gradient = normal.topRightCorner(p, 1);
  if (n > p && p > 0) {
    const auto cross = normal.block(0, p, p, n - p);
    MatrixXd right(n - p, p + 1);  // the start's products with the free parameters and with the residuals
    right << cross.transpose(), normal.block(p, n, n - p, 1);
    const MatrixXd solved = maths::SolveScaled(normal.block(p, p, n - p, n - p), right, 1e-12);
    information -= cross * solved.leftCols(p);
    gradient -= cross * solved.rightCols(1);
  }
  run->information.assign(information.data(), information.data() + information.size());
  run->gradient.assign(gradient.data(), gradient.data() + gradient.size());
}

// The solver's problem: all runs against one hypothesis. Owns the numbers that the solver moves.
class FitProblem {
 public:
  FitProblem(const Hypothesis& hypothesis, const std::vector<const RunData*>& runs,
             const std::vector<model::StartState>& starts, int jobs)
      : hypothesis_(hypothesis),
        runs_(runs),
        starts_(starts),
        jobs_(jobs),
        free_(hypothesis.Free()),
        start_values_(runs.size()),
        all_runs_(values_, start_values_, jobs),
        problem_(ProblemOptions(&all_runs_)) {
    values_.reserve(free_.size());
    for (const FreeParameter& parameter : free_) {
      values_.push_back(parameter.ToFitted(std::clamp(parameter.value, parameter.low, parameter.high)));
    }
    AddRuns();
    SetBounds();
  }

  void AddPrior(const Prior& prior) {
    if (free_.empty()) return;
    const Map<const VectorXd> centre(prior.centre.data(), static_cast<Eigen::Index>(free_.size()));
    const Map<const VectorXd> weight(prior.weight.data(), static_cast<Eigen::Index>(free_.size()));
    prior_ = std::make_unique<ceres::NormalPrior>(weight.cwiseSqrt().asDiagonal(), centre);
    problem_.AddResidualBlock(prior_.get(), nullptr, values_.data());
  }

  // Returns false if the solver cannot make progress because simulations fail.
  bool Solve(const FitOptions& options) {
    // A step that cannot be simulated is not an error. The flag belongs to the whole process: one thread sets
    // it before any solver reads it.
    [[maybe_unused]] static const auto quiet = FLAGS_minloglevel = google::GLOG_FATAL;
    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::DENSE_QR;
    if (!free_.empty() && runs_.size() > kFewRuns) EliminateStartsFirst(&solver);
    solver.max_num_iterations = options.most_iterations;
    solver.function_tolerance = options.tolerance;
    solver.parameter_tolerance = 0;  // the numbers have different units
    solver.gradient_tolerance = 0;
    if (!options.line_search) solver.max_num_line_search_step_size_iterations = 0;
    solver.num_threads = 1;
    solver.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(solver, &problem_, &summary);
    return summary.termination_type != ceres::FAILURE && summary.termination_type != ceres::USER_FAILURE;
  }

  // The hypothesis and its runs at the solver's result.
  Fitted Result() const {
    Fitted fitted;
    fitted.hypothesis = hypothesis_;
    std::vector<double> values, at;
    for (size_t i = 0; i < free_.size(); ++i) {
      const double value = free_[i].FromFitted(values_[i]);
      values.push_back(std::clamp(value, free_[i].low, free_[i].high));
      at.push_back(values[i] == value ? values_[i] : free_[i].ToFitted(values[i]));
    }
    fitted.hypothesis.Set(values);
    std::vector<const MatrixXd*> normals(runs_.size());
    ParallelFor(runs_.size(), jobs_,
                [&](size_t r) { normals[r] = costs_[r]->Normal(at.data(), start_values_[r].data()); });
    for (size_t r = 0; r < runs_.size(); ++r) {
      if (normals[r] == nullptr) {
        fitted.failure = kCannotBeSimulated;
        return fitted;
      }
      fitted.runs.push_back(ResultOf(r, *normals[r]));
      fitted.sum += fitted.runs.back().sum;
      fitted.count += fitted.runs.back().count;
    }
    return fitted;
  }

 private:
  static ceres::Problem::Options ProblemOptions(AllRuns* all_runs) {
    ceres::Problem::Options options;
    // `costs_` owns the cost functions. The problem would own only those added to it, and the cost of a run
    // with nothing free is not added.
    options.cost_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    options.evaluation_callback = all_runs;
    return options;
  }

  void AddRuns() {
    for (size_t r = 0; r < runs_.size(); ++r) {
      costs_.push_back(std::make_unique<RunCost>(hypothesis_, *runs_[r], starts_[r]));
      RunCost* const cost = costs_.back().get();
      all_runs_.Add(cost);
      for (size_t i = 0; i < cost->starts().size(); ++i) {
        start_values_[r][i] = starts_[r][cost->starts()[i].index];
      }
      std::vector<double*> blocks;
      if (!free_.empty()) blocks.push_back(values_.data());
      if (!cost->starts().empty()) blocks.push_back(start_values_[r].data());
      if (!blocks.empty()) problem_.AddResidualBlock(cost, nullptr, blocks);
    }
  }

  // Each run's start appears only in the equations of that run. With hundreds of windows, any other order
  // takes far longer than the simulations.
  void EliminateStartsFirst(ceres::Solver::Options* solver) {
    auto order = std::make_shared<ceres::ParameterBlockOrdering>();
    for (size_t r = 0; r < runs_.size(); ++r) {
      if (!costs_[r]->starts().empty()) order->AddElementToGroup(start_values_[r].data(), 0);
    }
    order->AddElementToGroup(values_.data(), 1);
    solver->linear_solver_type = ceres::DENSE_SCHUR;
    solver->linear_solver_ordering = std::move(order);
  }

  void SetBounds() {
    for (size_t i = 0; i < free_.size(); ++i) {
      const int place = static_cast<int>(i);
      const FreeParameter& free = free_[i];
      if (std::isfinite(free.low)) {
        problem_.SetParameterLowerBound(values_.data(), place, free.ToFitted(free.low));
      }
      if (std::isfinite(free.high)) {
        problem_.SetParameterUpperBound(values_.data(), place, free.ToFitted(free.high));
      }
    }
  }

  RunFit ResultOf(size_t r, const MatrixXd& normal) const {
    RunFit run;
    run.start = starts_[r];
    for (size_t i = 0; i < costs_[r]->starts().size(); ++i) {
      run.start[costs_[r]->starts()[i].index] = start_values_[r][i];
    }
    run.count = costs_[r]->count();
    run.sum = normal(normal.rows() - 1, normal.rows() - 1);
    EliminateStart(normal, static_cast<Eigen::Index>(free_.size()), &run);
    return run;
  }

  const Hypothesis& hypothesis_;
  const std::vector<const RunData*>& runs_;
  const std::vector<model::StartState>& starts_;
  int jobs_;
  std::vector<FreeParameter> free_;
  std::vector<double> values_;  // of the free parameters, as fitted
  // For each run, those that are free come first. They are in one array because the solver eliminates them in
  // the order of their addresses, and another order would round differently.
  std::vector<model::StartState> start_values_;
  std::vector<std::unique_ptr<RunCost>> costs_;
  std::unique_ptr<ceres::CostFunction> prior_;
  AllRuns all_runs_;
  ceres::Problem problem_;
};

}  // namespace

std::vector<model::StartState> StartsOf(const Fitted& fitted) {
  std::vector<model::StartState> starts;
  starts.reserve(fitted.runs.size());
  for (const RunFit& run : fitted.runs) starts.push_back(run.start);
  return starts;
}

Fitted Fit(const Hypothesis& hypothesis, const std::vector<const RunData*>& runs,
           const std::vector<model::StartState>& from, const FitOptions& options) {
  std::vector<model::StartState> starts = from;
  if (!options.at_turn) {
    ParallelFor(runs.size(), options.jobs,
                [&](size_t r) { starts[r] = AtBestTurn(hypothesis.model, *runs[r], from[r]); });
  }
  FitProblem problem(hypothesis, runs, starts, options.jobs);
  if (hypothesis.known != nullptr) problem.AddPrior(KnownToAFit(hypothesis));
  if (problem.Solve(options)) return problem.Result();
  Fitted failed;
  failed.hypothesis = hypothesis;
  failed.failure = kCannotBeSimulated;
  return failed;
}

}  // namespace hydro::diagnose
