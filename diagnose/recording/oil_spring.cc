#include "diagnose/recording/oil_spring.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "runs/measured/sample_times.h"

namespace hydro::diagnose {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Run = runs::MeasuredRun;

// In time constants of the pump on the oil: in slower motion, oil leaks away.
constexpr double kFastOil = 5;
// The relative prior uncertainty of a model's inertia, and of its friction.
constexpr double kInertiaKnown = 0.2, kFrictionKnown = 3;

VectorXd Integral(const std::vector<double>& time, const VectorXd& rate) {
  VectorXd integral = VectorXd::Zero(rate.size());
  for (Index i = 1; i < rate.size(); ++i) {
    const auto k = static_cast<size_t>(i);
    integral[i] = integral[i - 1] + 0.5 * (rate[i] + rate[i - 1]) * (time[k] - time[k - 1]);
  }
  return integral;
}

// Moving means over 2 `half` + 1 values. The result is shorter by `half` at each end.
VectorXd Means(const VectorXd& values, Index half) {
  VectorXd means(values.size() - 2 * half);
  double sum = values.head(2 * half + 1).sum();
  const double count = static_cast<double>(2 * half + 1);
  for (Index i = 0; i < means.size(); ++i) {
    means[i] = sum / count;
    if (i + 1 < means.size()) sum += values[i + 2 * half + 1] - values[i];
  }
  return means;
}

VectorXd WithoutSlow(VectorXd values, Index half) {
  for (int pass = 0; pass < 2; ++pass)
    values = (values.segment(half, values.size() - 2 * half) - Means(values, half)).eval();
  return values;
}

class Recorded {
 public:
  Recorded(const model::Parameters& model, const Run& run) : p_(model), time_(run.time) {
    torque_ = (model.k_1 * Held(run.voltage.values)).cwiseMin(model.T_pmax).cwiseMax(-model.T_pmax);
    if (run.motor_speed.measured()) {
      speed_ = Held(run.motor_speed.values);
      angle_ = Integral(time_, speed_);
    } else {
      angle_ = Held(run.motor_angle.values);
      speed_ = VectorXd::Zero(angle_.size());
      for (Index i = 1; i + 1 < angle_.size(); ++i) {
        const auto k = static_cast<size_t>(i);
        speed_[i] = (angle_[i + 1] - angle_[i - 1]) / (time_[k + 1] - time_[k - 1]);
      }
    }
    if (run.shaft != model::Shaft::kClamped) {
      arm_ =
          run.arm_angle.measured() ? Held(run.arm_angle.values) : Integral(time_, Held(run.arm_speed.values));
    }
  }

  // Empty where the run is too short or too slow.
  std::optional<OilSpring> Fitted() const {
    const double duration = time_.back() - time_.front();
    const double on_oil = std::sqrt(p_.J * p_.V_ms / (2 * p_.beta)) / p_.D;
    const double window = std::min(kFastOil * on_oil, duration / 8);
    const auto half = static_cast<Index>(window / runs::MedianInterval(time_));
    if (half < 5 || angle_.size() < 8 * half || Rms(torque_) == 0) return std::nullopt;
    OilSpring found;
    VectorXd squeezed = angle_;  // the motion that the oil has to take up, as a motor angle
    if (arm_.size() > 0) {
      squeezed -= p_.c / p_.D * arm_;
      const VectorXd motor = WithoutSlow(angle_, half), arm = WithoutSlow(arm_, half);
      const double both = motor.dot(arm);
      found.follows = both / std::max(motor.norm() * arm.norm(), 1e-300);
      found.volume = p_.c / p_.D * both / std::max(motor.squaredNorm(), 1e-300);
      const double turned = angle_.maxCoeff() - angle_.minCoeff();
      found.moved = p_.c / p_.D * (arm_.maxCoeff() - arm_.minCoeff()) / std::max(turned, 1e-300);
    }
    const double oil = 2 * p_.beta * p_.D * p_.D / p_.V_ms;
    found.at_most = oil * (squeezed.maxCoeff() - squeezed.minCoeff()) / Rms(torque_);
    // The torque balance, integrated over time, so that no speed is differentiated.
    const double turning = 0.02 * Rms(speed_);
    const VectorXd direction =
        speed_.unaryExpr([turning](double w) { return static_cast<double>((w > turning) - (w < -turning)); });
    const VectorXd torque = WithoutSlow(Integral(time_, torque_), half);
    MatrixXd terms(torque.size(), 4);
    terms << p_.J * WithoutSlow(speed_, half), p_.b * WithoutSlow(angle_, half),
        p_.T_s * WithoutSlow(Integral(time_, direction), half),
        oil * WithoutSlow(Integral(time_, squeezed), half);
    found.would_take = Rms(terms.col(3)) / Rms(torque);
    Fit(terms.leftCols(3), torque, 2 * duration / window, &found);
    Fit(terms, torque, 2 * duration / window, &found);
    return found;
  }

 private:
  // Fits as many terms as are given, from inertia, damping, friction, oil.
  static void Fit(const MatrixXd& terms, const VectorXd& torque, double independent, OilSpring* found) {
    const Index count = terms.cols();
    const bool oil = count == 4;
    VectorXd precision = VectorXd::Constant(count, 1 / (kFrictionKnown * kFrictionKnown));
    precision[0] = 1 / (kInertiaKnown * kInertiaKnown);
    if (oil) precision[3] = 1e-12;
    double left = 1;
    for (int pass = 0; pass < 5; ++pass) {
      const double weight = independent / (left * torque.squaredNorm());
      MatrixXd normal = weight * terms.transpose() * terms;
      normal += MatrixXd(precision.asDiagonal());
      const Eigen::LDLT<MatrixXd> solved(normal);
      const VectorXd values = solved.solve(weight * terms.transpose() * torque + precision);
      left = std::max(1e-6, (torque - terms * values).squaredNorm() / torque.squaredNorm());
      (oil ? found->stiffness : found->inertia) = values[oil ? 3 : 0];
      if (oil) found->error = std::sqrt(solved.solve(VectorXd::Unit(count, 3))[3]);
    }
    (oil ? found->left : found->left_without) = left;
  }

  const model::Parameters& p_;
  const std::vector<double>& time_;
  VectorXd torque_, speed_, angle_, arm_;
};

}  // namespace

Eigen::VectorXd Held(const std::vector<double>& values) {
  Eigen::VectorXd held(static_cast<Index>(values.size()));
  double last = 0;
  for (size_t i = 0; i < values.size(); ++i) {
    if (!std::isnan(values[i])) last = values[i];
    held[static_cast<Index>(i)] = last;
  }
  return held;
}

double Rms(const Eigen::VectorXd& values) {
  return std::sqrt(values.squaredNorm() / static_cast<double>(values.size()));
}

std::optional<OilSpring> FitOilSpring(const model::Parameters& model, const runs::MeasuredRun& run) {
  return Recorded(model, run).Fitted();
}

}  // namespace hydro::diagnose
