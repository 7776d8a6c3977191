#include "diagnose/recording/smoothed_motion.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace hydro::diagnose {
namespace {

// Angle, rate and acceleration, in a unit of time that gives them similar magnitudes.
using MotionState = Eigen::Vector3d;
using Covariance = Eigen::Matrix3d;

// Quintic polynomials between points that each have a value, a rate and an acceleration.
class Quintics : public trajectory::Trajectory {
 public:
  // `unit`: the unit of time of the points' rates and accelerations, in s.
  Quintics(std::vector<double> times, const std::vector<MotionState>& points, double unit)
      : times_(std::move(times)), first_(points.front()[0]), last_(points.back()[0]) {
    min_ = max_ = first_;
    for (size_t i = 1; i < times_.size(); ++i) {
      const double h = (times_[i] - times_[i - 1]) / unit;
      const MotionState& a = points[i - 1];
      const MotionState& b = points[i];
      // With s from 0 to 1 over the interval: value = sum of coefficients[k] s^k.
      const double rise = b[0] - a[0] - h * a[1] - h * h * a[2] / 2;
      const double rate = h * (b[1] - a[1] - h * a[2]);
      const double bend = h * h * (b[2] - a[2]) / 2;
      pieces_.push_back({a[0], h * a[1], h * h * a[2] / 2, 10 * rise - 4 * rate + bend,
                         -15 * rise + 7 * rate - 2 * bend, 6 * rise - 3 * rate + bend});
      // Between samples a smooth motion hardly exceeds its samples, so it is enough to check the halves.
      for (const double s : {0.5, 1.0}) {
        min_ = std::min(min_, At(pieces_.back(), s));
        max_ = std::max(max_, At(pieces_.back(), s));
      }
    }
  }

  double Value(double t) const override {
    const size_t after = After(t);
    if (after == 0) return first_;
    if (after == times_.size()) return last_;
    return At(pieces_[after - 1], (t - times_[after - 1]) / (times_[after] - times_[after - 1]));
  }

  double Rate(double t) const override {
    const size_t after = After(t);
    if (after == 0 || after == times_.size()) return 0;
    const double h = times_[after] - times_[after - 1];
    const double s = (t - times_[after - 1]) / h;
    const Coefficients& c = pieces_[after - 1];
    return (c[1] + s * (2 * c[2] + s * (3 * c[3] + s * (4 * c[4] + s * 5 * c[5])))) / h;
  }

  double NextBreak(double t) const override {
    const size_t after = After(t);
    return after == times_.size() ? std::numeric_limits<double>::infinity() : times_[after];
  }
  bool continuous() const override { return true; }
  double Min() const override { return min_; }
  double Max() const override { return max_; }

 private:
  using Coefficients = std::array<double, 6>;

  static double At(const Coefficients& c, double s) {
    return c[0] + s * (c[1] + s * (c[2] + s * (c[3] + s * (c[4] + s * c[5]))));
  }
  size_t After(double t) const {
    return static_cast<size_t>(std::ranges::upper_bound(times_, t) - times_.begin());
  }

  std::vector<double> times_;
  std::vector<Coefficients> pieces_;
  double first_, last_, min_ = 0, max_ = 0;
};

struct Belief {
  MotionState mean = MotionState::Zero();
  Covariance covariance = Covariance::Zero();

  // Processes a reading of one of the states; returns -2 times its log likelihood.
  double Update(int which, double reading, double noise) {
    const Eigen::Vector3d column = covariance.col(which);
    const double variance = column[which] + noise * noise;
    const double off = reading - mean[which];
    mean += column * (off / variance);
    covariance -= column * column.transpose() / variance;
    return off * off / variance + std::log(variance);
  }
};

Eigen::Matrix3d Transition(double h) {
  Eigen::Matrix3d transition;
  transition << 1, h, h * h / 2, 0, 1, h, 0, 0, 1;
  return transition;
}

// A Kalman filter over the samples, and the smoother of Rauch, Tung and Striebel.
class Smoother {
 public:
  Smoother(const std::vector<double>& time, const std::vector<double>& angle, double angle_noise,
           const std::vector<double>& rate, double rate_noise)
      : time_(time), angle_(angle), rate_(rate), angle_noise_(angle_noise) {
    unit_ = (time.back() - time.front()) / static_cast<double>(time.size() - 1);
    rate_noise_ = rate_noise * unit_;
    first_angle_ = *std::ranges::find_if(angle, [](double a) { return !std::isnan(a); });
    for (const double a : angle) {
      if (!std::isnan(a)) range_ = std::max(range_, std::abs(a - first_angle_));
    }
    predicted_.resize(time.size());
    filtered_.resize(time.size());
  }

  // -2 times the log likelihood of the samples when the jerk is white noise of this strength.
  double Misfit(double strength) {
    double misfit = 0;
    Belief now;
    now.mean[0] = first_angle_;
    // A vague prior: any motion that moves within one unit of time no further than the samples do.
    now.covariance = std::pow(range_ + angle_noise_, 2) * Covariance::Identity();
    for (size_t i = 0; i < time_.size(); ++i) {
      if (i > 0) {
        const double h = (time_[i] - time_[i - 1]) / unit_;
        const Eigen::Matrix3d transition = Transition(h);
        const double h2 = h * h, h3 = h2 * h, h4 = h2 * h2, h5 = h4 * h;
        Covariance added;
        added << h5 / 20, h4 / 8, h3 / 6, h4 / 8, h3 / 3, h2 / 2, h3 / 6, h2 / 2, h;
        now.mean = transition * now.mean;
        now.covariance = transition * now.covariance * transition.transpose() + strength * added;
      }
      predicted_[i] = now;
      if (!std::isnan(angle_[i])) misfit += now.Update(0, angle_[i], angle_noise_);
      if (!rate_.empty() && !std::isnan(rate_[i])) misfit += now.Update(1, rate_[i] * unit_, rate_noise_);
      filtered_[i] = now;
    }
    return misfit;
  }

  // Call after Misfit.
  std::vector<MotionState> Smooth() const {
    std::vector<MotionState> points(time_.size());
    points.back() = filtered_.back().mean;
    for (size_t i = time_.size() - 1; i-- > 0;) {
      const Belief& next = predicted_[i + 1];
      const Eigen::Matrix3d transition = Transition((time_[i + 1] - time_[i]) / unit_);
      points[i] = filtered_[i].mean + filtered_[i].covariance * transition.transpose() *
                                          next.covariance.ldlt().solve(points[i + 1] - next.mean);
    }
    return points;
  }

  double range() const { return range_; }
  double unit() const { return unit_; }

 private:
  const std::vector<double>& time_;
  const std::vector<double>& angle_;
  const std::vector<double>& rate_;
  double angle_noise_, rate_noise_ = 0;
  double unit_ = 1, first_angle_ = 0, range_ = 0;
  std::vector<Belief> predicted_, filtered_;
};

}  // namespace

std::unique_ptr<trajectory::Trajectory> SmoothMotion(const std::vector<double>& time,
                                                     const std::vector<double>& angle, double angle_noise,
                                                     const std::vector<double>& rate, double rate_noise) {
  Smoother smoother(time, angle, angle_noise, rate, rate_noise);
  if (smoother.range() == 0) {
    const double held = *std::ranges::find_if(angle, [](double a) { return !std::isnan(a); });
    return std::make_unique<Quintics>(std::vector<double>{time.front()},
                                      std::vector<MotionState>{{held, 0, 0}}, 1.0);
  }
  // Search in steps of a decade over all possible strengths, then in steps of a fifth of a decade around the
  // best.
  const double lowest =
      2 * std::log10(smoother.range()) - 5 * std::log10(static_cast<double>(time.size())) - 3;
  const double highest = 2 * std::log10(smoother.range()) + 1;
  double best = lowest, least = std::numeric_limits<double>::infinity();
  const auto consider = [&](double exponent) {
    const double misfit = smoother.Misfit(std::pow(10, exponent));
    if (!(misfit < least)) return;
    least = misfit;
    best = exponent;
  };
  for (double exponent = lowest; exponent <= highest; exponent += 1) consider(exponent);
  const double coarse = best;
  for (int fifth = -3; fifth <= 3; ++fifth) consider(coarse + 0.2 * fifth);
  smoother.Misfit(std::pow(10, best));
  return std::make_unique<Quintics>(time, smoother.Smooth(), smoother.unit());
}

}  // namespace hydro::diagnose
