#include "diagnose/fit/run_cost.h"

#include <algorithm>
#include <cmath>

#include "base/maths/matrix_functions.h"

namespace hydro::diagnose {

using Eigen::Map;
using Eigen::MatrixXd;
using Eigen::VectorXd;

RunCost::RunCost(const Hypothesis& hypothesis, const RunData& run, const model::StartState& start)
    : hypothesis_(hypothesis),
      free_(hypothesis.Free()),
      run_(run),
      start_(start),
      starts_(StartUnknowns(hypothesis.model, run)) {
  if (!free_.empty()) mutable_parameter_block_sizes()->push_back(static_cast<int>(free_.size()));
  if (!starts_.empty()) mutable_parameter_block_sizes()->push_back(static_cast<int>(starts_.size()));
  set_num_residuals(static_cast<int>(unknowns()) + 1);
}

void RunCost::Prepare(const double* free, const double* start, bool derivatives) {
  with_derivatives_ = derivatives;
  if (!derivatives) {
    can_be_simulated_ = Simulate(free, start, false, &sum_);
    return;
  }
  at_.assign(free, free + free_.size());
  at_.insert(at_.end(), start, start + starts_.size());
  can_be_simulated_ = Simulate(free, start, true, &normal_);
  if (!can_be_simulated_) at_.clear();
}

const MatrixXd* RunCost::Normal(const double* free, const double* start) {
  const size_t p = free_.size();
  const bool there = at_.size() == unknowns() && normal_.size() > 0 &&
                     std::equal(free, free + p, at_.data()) &&
                     std::equal(start, start + starts_.size(), at_.data() + p);
  if (there) return &normal_;
  Prepare(free, start, true);
  return can_be_simulated_ ? &normal_ : nullptr;
}

bool RunCost::Evaluate(double const* const* /*parameters*/, double* residuals, double** jacobians) const {
  const auto p = static_cast<Eigen::Index>(free_.size());
  const auto n = static_cast<Eigen::Index>(unknowns());
  Map<VectorXd> out(residuals, n + 1);
  const MatrixXd& normal = with_derivatives_ ? normal_ : sum_;
  if (!can_be_simulated_ || (jacobians != nullptr && !with_derivatives_)) return false;
  out.setZero();
  if (jacobians == nullptr) {
    out(0) = std::sqrt(normal(normal.rows() - 1, normal.rows() - 1));
    return true;
  }
  // [J r]' [J r] = V L V'; the rows of L^1/2 V' serve as well as those of [J r]. Each column is measured by
  // its own size: rounding would lose small ones, and in other units others are small.
  VectorXd size = normal.diagonal().cwiseSqrt();
  for (double& one : size) one = one > 0 ? one : 1;
  const VectorXd scale = size.cwiseInverse();
  const maths::SymmetricEigensystem eigen =
      maths::SymmetricEigensystemOf(scale.asDiagonal() * normal * scale.asDiagonal());
  const MatrixXd root =
      eigen.values.cwiseMax(0.0).cwiseSqrt().asDiagonal() * eigen.vectors.transpose() * size.asDiagonal();
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

bool RunCost::Simulate(const double* free, const double* start, bool derivatives, MatrixXd* normal) {
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
  // Prior knowledge of the start holds it where the run says nothing, for example below p_3.
  std::vector<double> off(starts_.size()), weight(starts_.size());
  double start_sum = 0;
  for (size_t i = 0; i < starts_.size(); ++i) {
    const size_t state = starts_[i].index;
    weight[i] = 1 / run_.start_error[state];
    off[i] = weight[i] * (start[i] - run_.start[state]);
    start_sum += off[i] * off[i];
  }
  const auto rows = static_cast<Eigen::Index>(r.values.size());
  const Map<const VectorXd> residual(r.values.data(), rows);
  if (!derivatives) {
    *normal = MatrixXd::Constant(1, 1, residual.squaredNorm() + start_sum);
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
  (*normal)(n, n) = residual.squaredNorm() + start_sum;
  for (size_t i = 0; i < starts_.size(); ++i) {
    const auto place = static_cast<Eigen::Index>(free_.size() + i);
    (*normal)(place, place) += weight[i] * weight[i];
    (*normal)(place, n) += weight[i] * off[i];
    (*normal)(n, place) = (*normal)(place, n);
  }
  count_ = r.values.size();
  return normal->allFinite();
}

}  // namespace hydro::diagnose
