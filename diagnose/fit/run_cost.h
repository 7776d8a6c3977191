// One run's residuals as a cost function of Ceres.
#pragma once

#include <ceres/cost_function.h>

#include <Eigen/Core>
#include <vector>

#include "diagnose/fit/hypothesis.h"
#include "diagnose/fit/residuals.h"
#include "diagnose/recording/run_data.h"

namespace hydro::diagnose {

// One run against the hypothesis. There are hundreds of thousands of residuals, so the solver gets a square
// root of their normal equations instead: the same cost, gradient and Gauss-Newton matrix in a few numbers.
// Keeps references to the hypothesis and the run.
class RunCost : public ceres::CostFunction {
 public:
  RunCost(const Hypothesis& hypothesis, const RunData& run, const model::StartState& start);

  // Simulates the run at the point that the solver will ask for next.
  void Prepare(const double* free, const double* start, bool derivatives);

  // Evaluates at the prepared point.
  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override;

  // [J r]' [J r] at the point; null where the run cannot be simulated. The pointer is valid until the next
  // call. The call costs nothing at the point of the last derivatives, which is where a solver ends.
  const Eigen::MatrixXd* Normal(const double* free, const double* start);

  // How many residuals the run had when derivatives were last computed.
  size_t count() const { return count_; }
  const std::vector<model::Unknown>& starts() const { return starts_; }

 private:
  size_t unknowns() const { return free_.size() + starts_.size(); }
  // Computes [J r]' [J r] at the point, or only r'r without derivatives. Returns false where the run cannot
  // be simulated.
  bool Simulate(const double* free, const double* start, bool derivatives, Eigen::MatrixXd* normal);

  const Hypothesis& hypothesis_;
  std::vector<FreeParameter> free_;
  const RunData& run_;
  model::StartState start_;
  std::vector<model::Unknown> starts_;
  size_t count_ = 0;
  bool can_be_simulated_ = false;
  bool with_derivatives_ = false;  // the last call of Prepare() asked for derivatives
  Eigen::MatrixXd sum_;            // r'r of the last point without derivatives
  Eigen::MatrixXd normal_;         // of the last point with derivatives, which is `at_`
  std::vector<double> at_;
};

}  // namespace hydro::diagnose
