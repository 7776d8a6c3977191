#include "base/maths/linear_fit.h"

#include <Eigen/QR>
#include <boost/math/distributions/students_t.hpp>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "base/maths/matrix_functions.h"

namespace hydro::maths {

double LinearFit::Value(const std::vector<double>& weights) const {
  double value = 0;
  for (size_t i = 0; i < coefficients.size(); ++i) value += weights[i] * coefficients[i];
  return value;
}

double LinearFit::StandardError(const std::vector<double>& weights) const {
  double variance = 0;
  for (size_t i = 0; i < coefficients.size(); ++i) {
    for (size_t j = 0; j < coefficients.size(); ++j) {
      variance += weights[i] * weights[j] * covariance[i * coefficients.size() + j];
    }
  }
  return std::sqrt(std::max(0.0, variance));
}

double LinearFit::HalfWidth95(const std::vector<double>& weights) const {
  return degrees_of_freedom > 0 ? StudentT95(degrees_of_freedom) * StandardError(weights)
                                : std::numeric_limits<double>::infinity();
}

LinearFit FitLinear(const std::vector<std::vector<double>>& regressors, const std::vector<double>& y) {
  const auto rows = static_cast<Eigen::Index>(y.size());
  const auto columns = static_cast<Eigen::Index>(regressors.size());
  Eigen::MatrixXd design(rows, columns);
  for (Eigen::Index j = 0; j < columns; ++j) {
    design.col(j) = Eigen::Map<const Eigen::VectorXd>(regressors[static_cast<size_t>(j)].data(), rows);
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(design);
  if (rows < columns || qr.rank() < columns) {
    throw std::invalid_argument("a linear fit of " + std::to_string(columns) +
                                " coefficients to measurements that do not determine them");
  }
  const auto measured = Eigen::Map<const Eigen::VectorXd>(y.data(), rows);
  const Eigen::VectorXd solution = qr.solve(measured);
  const double squares = (measured - design * solution).squaredNorm();

  LinearFit fit;
  fit.coefficients.assign(solution.data(), solution.data() + columns);
  fit.degrees_of_freedom = static_cast<int>(rows - columns);
  fit.residual_deviation = fit.degrees_of_freedom > 0 ? std::sqrt(squares / fit.degrees_of_freedom) : 0;
  const Eigen::MatrixXd covariance =
      Inverse(design.transpose() * design) * (fit.residual_deviation * fit.residual_deviation);
  fit.covariance.assign(covariance.data(), covariance.data() + covariance.size());
  return fit;
}

double StudentT95(int degrees_of_freedom) {
  if (degrees_of_freedom <= 0) return std::numeric_limits<double>::infinity();
  return boost::math::quantile(boost::math::students_t(degrees_of_freedom), 0.975);
}

}  // namespace hydro::maths
