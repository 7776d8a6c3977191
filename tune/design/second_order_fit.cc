#include "tune/design/second_order_fit.h"

#include <ceres/tiny_solver.h>
#include <ceres/tiny_solver_autodiff_function.h>

#include <Eigen/Core>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "base/units.h"

namespace hydro::design {
namespace {

// Residuals: ln |measured/fitted| and the phase of measured/fitted, in radians, point by point. Unknowns: ln
// K, ln wn, ln zeta, delay (held at 0 unless requested).
struct Residuals {
  using Scalar = double;
  enum { NUM_RESIDUALS = Eigen::Dynamic, NUM_PARAMETERS = 4 };

  int NumResiduals() const { return 2 * static_cast<int>(points->size()); }

  template <class T>
  bool operator()(const T* unknown, T* residuals) const {
    using std::atan2;
    using std::exp;
    using std::log;
    const T wn = exp(unknown[1]);
    const T zeta = exp(unknown[2]);
    for (size_t i = 0; i < points->size(); ++i) {
      const double w = 2 * std::numbers::pi * (*points)[i].frequency_hz;
      const T re = 1.0 - w * w / (wn * wn);
      const T im = 2.0 * zeta * w / wn;
      const T fitted_phase = -atan2(im, re) - (with_delay ? unknown[3] * w : T(0.0));
      residuals[2 * i] = std::log(std::abs((*points)[i].gain)) - (unknown[0] - 0.5 * log(re * re + im * im));
      residuals[2 * i + 1] = phases[i] - fitted_phase;
    }
    return true;
  }

  const std::vector<ResponsePoint>* points;
  std::vector<double> phases;  // rad
  bool with_delay;
};

double RootMeanSquare(const Eigen::VectorXd& residuals, int first) {
  double sum = 0;
  for (Eigen::Index i = first; i < residuals.size(); i += 2) sum += residuals[i] * residuals[i];
  return std::sqrt(sum / (static_cast<double>(residuals.size()) / 2));
}

}  // namespace

std::complex<double> SecondOrderModel::Gain(double frequency_hz) const {
  const double w = 2 * std::numbers::pi * frequency_hz;
  const double x = w / natural_frequency;
  return static_gain * std::polar(1.0, -w * delay) / std::complex<double>(1 - x * x, 2 * damping_ratio * x);
}

double SecondOrderModel::BandwidthHz() const {
  // (1 - y)^2 + 4 zeta^2 y = 2 for y = (w/wn)^2.
  const double a = 1 - 2 * damping_ratio * damping_ratio;
  return natural_frequency * std::sqrt(a + std::sqrt(a * a + 1)) / (2 * std::numbers::pi);
}

SecondOrderFit FitSecondOrder(const std::vector<ResponsePoint>& points,
                              const SecondOrderFitSettings& settings) {
  std::vector<ResponsePoint> counted;
  for (const ResponsePoint& point : points) {
    if (point.frequency_hz >= settings.first_hz && point.frequency_hz <= settings.last_hz &&
        point.coherence >= settings.least_coherence && std::abs(point.gain) > 0) {
      counted.push_back(point);
    }
  }
  if (counted.size() < 4) {
    throw std::invalid_argument("second-order fit: found " + std::to_string(counted.size()) +
                                " points that count, must be at least 4");
  }
  Residuals residuals = {&counted, PhasesDeg(counted), settings.with_delay};
  for (double& phase : residuals.phases) phase *= kDegree;

  // Start where the phase crosses -90 degrees.
  double wn = 2 * std::numbers::pi * counted.back().frequency_hz;
  for (size_t i = 0; i < counted.size(); ++i) {
    if (residuals.phases[i] > -std::numbers::pi / 2) continue;
    wn = 2 * std::numbers::pi * counted[i].frequency_hz;
    break;
  }
  using Function = ceres::TinySolverAutoDiffFunction<Residuals, Eigen::Dynamic, 4>;
  const Function function(residuals);
  ceres::TinySolver<Function> solver;
  solver.options.max_num_iterations = 200;
  solver.options.gradient_tolerance = 1e-12;
  solver.options.parameter_tolerance = 1e-12;
  Eigen::Vector4d unknown(std::log(std::abs(counted.front().gain)), std::log(wn), std::log(0.7), 0);
  solver.Solve(function, &unknown);

  Eigen::VectorXd left(residuals.NumResiduals());
  residuals(unknown.data(), left.data());
  SecondOrderFit fit;
  fit.model = {std::exp(unknown[0]), std::exp(unknown[1]), std::exp(unknown[2]),
               settings.with_delay ? unknown[3] : 0};
  fit.rms_error_db = RootMeanSquare(left, 0) * 20 / std::numbers::ln10;
  fit.rms_error_deg = RootMeanSquare(left, 1) / kDegree;
  fit.points = static_cast<int>(counted.size());
  return fit;
}

}  // namespace hydro::design
