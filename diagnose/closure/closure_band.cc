#include "diagnose/closure/closure_band.h"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <string>

#include "diagnose/fit/comparison.h"
#include "maths/solve.h"

namespace hydro::diagnose {
namespace {

using Eigen::Index;
using Eigen::Map;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kTwoSided95 = 1.96;

struct Normal {
  MatrixXd information;  // scaled: its diagonal is 1
  VectorXd scale, gradient;
};

// `known`: what is known of each value beforehand, a weight each, or nothing.
Normal NormalOf(const Fitted& fitted, Index n, const std::vector<double>& known = {}) {
  Normal normal{MatrixXd::Zero(n, n), {}, VectorXd::Zero(n)};
  for (const RunFit& run : fitted.runs) {
    normal.information += Map<const MatrixXd>(run.information.data(), n, n);
    normal.gradient += Map<const VectorXd>(run.gradient.data(), n);
  }
  for (size_t i = 0; i < known.size(); ++i)
    normal.information(static_cast<Index>(i), static_cast<Index>(i)) += known[i];
  normal.scale = (normal.information.diagonal().array() + 1e-300).sqrt().inverse();
  normal.information = normal.scale.asDiagonal() * normal.information * normal.scale.asDiagonal();
  // Values that no window tells apart: a little keeps the inverse finite and their bands wide.
  normal.information.diagonal().array() += 1e-9;
  return normal;
}

// Of the values that are not a closure's, for a covariance of the inverse times `inflation`.
std::vector<double> WeightsOfOwn(const std::vector<FreeParameter>& free, double inflation) {
  std::vector<double> weights;
  for (const FreeParameter& one : free) {
    const double spread = one.name.starts_with("closure.") ? 0
                          : one.logarithmic                ? kNear
                                                           : kNear * std::abs(one.value);
    weights.push_back(spread > 0 ? inflation / (spread * spread) : 0);
  }
  return weights;
}

}  // namespace

double FirstStep(const Fitted& fitted) {
  if (!fitted.ok() || fitted.runs.empty()) return 0;
  const auto n = static_cast<Index>(fitted.hypothesis.Free().size());
  const Normal normal = NormalOf(fitted, n);
  const VectorXd gradient = normal.scale.asDiagonal() * normal.gradient;
  MatrixXd damped = normal.information;
  damped.diagonal().array() += 1e-3;
  return gradient.dot(maths::SolveSymmetric(damped, gradient).col(0));
}

void SetBand(const Fitted& fitted, const std::vector<const RunData*>& windows, Closure* closure) {
  const std::vector<FreeParameter> free = fitted.hypothesis.Free();
  const auto n = static_cast<Index>(free.size());
  const double inflation = std::max(1.0, fitted.squared_gap()) * CorrelationOf(windows, fitted);
  const Normal normal = NormalOf(fitted, n, WeightsOfOwn(free, inflation));
  const MatrixXd inverse = maths::SolveSymmetric(normal.information, MatrixXd::Identity(n, n));
  const std::string own = closure->id + ".values[";
  for (Index i = 0; i < n; ++i) {
    if (!free[static_cast<size_t>(i)].name.starts_with(own)) continue;
    const double half = kTwoSided95 * std::sqrt(std::max(0.0, inflation * inverse(i, i))) * normal.scale[i];
    const double value = free[static_cast<size_t>(i)].value;
    closure->low.push_back(value - half);
    closure->high.push_back(value + half);
  }
}

}  // namespace hydro::diagnose
