#include "diagnose/fit/arm_load.h"

#include <Eigen/Dense>
#include <cmath>

namespace hydro::diagnose {
namespace {

constexpr double kFewest = 12;  // samples
// Of an arm that stands nearly upright, no weight follows from its motion.
constexpr double kLeastLever = 0.1;

}  // namespace

std::optional<model::ModelDescription> WithLoadOf(const model::ModelDescription& model,
                                                  const runs::MeasuredRun& window) {
  const bool measured = window.arm_angle.measured() && window.p1.measured() && window.p2.measured();
  if (!measured || window.shaft != model::Shaft::kFree) return std::nullopt;
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  double dp = 0, n = 0;
  const double half = 0.5 * (window.time.back() - window.time.front()), middle = window.time.front() + half;
  for (size_t i = 0; i < window.samples(); ++i) {
    const double angle = window.arm_angle.values[i], here = window.p2.values[i] - window.p1.values[i];
    if (std::isnan(angle) || std::isnan(here)) continue;
    const double at = (window.time[i] - middle) / half;
    const Eigen::Vector3d row{1, at, at * at};
    normal += row * row.transpose();
    right += row * angle;
    dp += here;
    n += 1;
  }
  if (n < kFewest) return std::nullopt;
  const Eigen::Vector3d parabola = normal.ldlt().solve(right);
  const double acceleration = 2 * parabola(2) / (half * half);
  const double lever = std::cos(parabola(0));
  if (std::abs(lever) < kLeastLever) return std::nullopt;
  model::ModelDescription loaded = model;
  loaded.parameters.mgl = (model.parameters.k_2 * dp / n - model.parameters.J_a * acceleration) / lever;
  return loaded;
}

}  // namespace hydro::diagnose
