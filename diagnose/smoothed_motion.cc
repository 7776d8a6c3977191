#include "diagnose/smoothed_motion.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

namespace hydro {
namespace {

// Cubics between points that each have a value and a rate.
class Cubics : public Trajectory {
 public:
  struct Point {
    double time, value, rate;
  };

  explicit Cubics(std::vector<Point> points) : points_(std::move(points)) {
    min_ = max_ = points_.front().value;
    for (size_t i = 0; i < points_.size(); ++i) {
      Include(points_[i].value);
      if (i == 0) continue;
      // Where the cubic's rate, m0 + s (l + s q), is 0.
      const auto [m0, l, q] = RateOver(i);
      const double root = std::sqrt(std::max(0.0, l * l - 4 * m0 * q));
      for (const double at : {(-l - root) / (2 * q), (-l + root) / (2 * q), -m0 / l}) {
        if (at > 0 && at < 1) Include(Value(points_[i - 1].time + at * Length(i)));
      }
    }
  }

  double Value(double t) const override {
    const size_t after = After(t);
    if (after == 0) return points_.front().value;
    const Point& from = points_[after - 1];
    if (after == points_.size()) return from.value;
    const double since = t - from.time;
    const double s = since / Length(after);
    const auto [m0, l, q] = RateOver(after);
    return from.value + since * (m0 + s * (l / 2 + s * q / 3));
  }

  double Rate(double t) const override {
    const size_t after = After(t);
    if (after == 0 || after == points_.size()) return 0;
    const double s = (t - points_[after - 1].time) / Length(after);
    const auto [m0, l, q] = RateOver(after);
    return m0 + s * (l + s * q);
  }

  double NextBreak(double t) const override {
    const size_t after = After(t);
    return after == points_.size() ? std::numeric_limits<double>::infinity() : points_[after].time;
  }
  bool continuous() const override { return true; }
  double Min() const override { return min_; }
  double Max() const override { return max_; }

 private:
  struct Quadratic {
    double constant, linear, square;
  };

  void Include(double value) {
    min_ = std::min(min_, value);
    max_ = std::max(max_, value);
  }
  double Length(size_t i) const { return points_[i].time - points_[i - 1].time; }
  // The rate between points i - 1 and i over the part of the way, 0 to 1.
  Quadratic RateOver(size_t i) const {
    const Point& from = points_[i - 1];
    const double rise = (points_[i].value - from.value) / Length(i);
    return {from.rate, 2 * (3 * rise - 2 * from.rate - points_[i].rate),
            3 * (from.rate + points_[i].rate - 2 * rise)};
  }
  size_t After(double t) const {
    return static_cast<size_t>(std::upper_bound(points_.begin(), points_.end(), t,
                                                [](double time, const Point& p) { return time < p.time; }) -
                               points_.begin());
  }

  std::vector<Point> points_;
  double min_ = 0, max_ = 0;
};

// What is known of angle and rate at a time: means and covariance.
struct Belief {
  double angle = 0, rate = 0;
  double aa = 0, ar = 0, rr = 0;
};

// A Kalman filter over the samples, and Rauch, Tung and Striebel's smoother.
class Smoother {
 public:
  Smoother(const std::vector<double>& time, const std::vector<double>& angle, double angle_noise,
           const std::vector<double>& rate, double rate_noise)
      : time_(time), angle_(angle), rate_(rate), angle_noise_(angle_noise), rate_noise_(rate_noise) {
    first_angle_ = *std::find_if(angle.begin(), angle.end(), [](double a) { return !std::isnan(a); });
    for (const double a : angle) {
      if (!std::isnan(a)) range_ = std::max(range_, std::abs(a - first_angle_));
    }
    // Of anything that moves so far in so little time.
    const double step = (time.back() - time.front()) / static_cast<double>(time.size() - 1);
    fastest_ = (range_ + angle_noise) / step;
    predicted_.resize(time.size());
    filtered_.resize(time.size());
  }

  // -2 log likelihood of the samples when the acceleration is white noise of that strength (rad^2/s^3).
  double Misfit(double strength) {
    double misfit = 0;
    Belief now;
    now.angle = first_angle_;
    now.aa = (range_ + angle_noise_) * (range_ + angle_noise_);
    now.rr = fastest_ * fastest_;
    for (size_t i = 0; i < time_.size(); ++i) {
      if (i > 0) {
        const double h = time_[i] - time_[i - 1];
        now.angle += h * now.rate;
        now.aa += h * (2 * now.ar + h * now.rr) + strength * h * h * h / 3;
        now.ar += h * now.rr + strength * h * h / 2;
        now.rr += strength * h;
      }
      predicted_[i] = now;
      if (!std::isnan(angle_[i])) {
        const double s = now.aa + angle_noise_ * angle_noise_;
        const double off = angle_[i] - now.angle;
        misfit += off * off / s + std::log(s);
        const double ka = now.aa / s, kr = now.ar / s;
        now.angle += ka * off;
        now.rate += kr * off;
        now.rr -= kr * now.ar;
        now.ar *= 1 - ka;
        now.aa *= 1 - ka;
      }
      if (!rate_.empty() && !std::isnan(rate_[i])) {
        const double s = now.rr + rate_noise_ * rate_noise_;
        const double off = rate_[i] - now.rate;
        misfit += off * off / s + std::log(s);
        const double ka = now.ar / s, kr = now.rr / s;
        now.angle += ka * off;
        now.rate += kr * off;
        now.aa -= ka * now.ar;
        now.ar *= 1 - kr;
        now.rr *= 1 - kr;
      }
      filtered_[i] = now;
    }
    return misfit;
  }

  // After Misfit.
  std::vector<Cubics::Point> Smooth() const {
    std::vector<Cubics::Point> points(time_.size());
    points.back() = {time_.back(), filtered_.back().angle, filtered_.back().rate};
    for (size_t i = time_.size() - 1; i-- > 0;) {
      const Belief& f = filtered_[i];
      const Belief& p = predicted_[i + 1];
      const double h = time_[i + 1] - time_[i];
      // gain = filtered covariance * transition^T * predicted covariance^-1
      const double m00 = f.aa + h * f.ar, m01 = f.ar, m10 = f.ar + h * f.rr, m11 = f.rr;
      const double det = p.aa * p.rr - p.ar * p.ar;
      const double angle_off = points[i + 1].value - p.angle;
      const double rate_off = points[i + 1].rate - p.rate;
      const double u = (p.rr * angle_off - p.ar * rate_off) / det;
      const double v = (p.aa * rate_off - p.ar * angle_off) / det;
      points[i] = {time_[i], f.angle + m00 * u + m01 * v, f.rate + m10 * u + m11 * v};
    }
    return points;
  }

  double range() const { return range_; }

 private:
  const std::vector<double>& time_;
  const std::vector<double>& angle_;
  const std::vector<double>& rate_;
  double angle_noise_, rate_noise_;
  double first_angle_ = 0, range_ = 0, fastest_ = 0;
  std::vector<Belief> predicted_, filtered_;
};

}  // namespace

std::unique_ptr<Trajectory> SmoothMotion(const std::vector<double>& time, const std::vector<double>& angle,
                                         double angle_noise, const std::vector<double>& rate,
                                         double rate_noise) {
  Smoother smoother(time, angle, angle_noise, rate, rate_noise);
  if (smoother.range() == 0) {
    const double held = *std::find_if(angle.begin(), angle.end(), [](double a) { return !std::isnan(a); });
    return std::make_unique<Cubics>(std::vector<Cubics::Point>{{time.front(), held, 0}});
  }
  // Steps of a decade over all strengths that could be, then of a tenth around the best.
  const double duration = time.back() - time.front();
  const double step = duration / static_cast<double>(time.size() - 1);
  const double lowest = std::log10(smoother.range() * smoother.range() / std::pow(duration, 3)) - 4;
  const double highest = std::log10(smoother.range() * smoother.range() / std::pow(step, 3)) + 1;
  double best = lowest, least = std::numeric_limits<double>::infinity();
  const auto consider = [&](double exponent) {
    const double misfit = smoother.Misfit(std::pow(10, exponent));
    if (misfit >= least) return;
    least = misfit;
    best = exponent;
  };
  for (double exponent = lowest; exponent <= highest; exponent += 1) consider(exponent);
  const double coarse = best;
  for (int tenth = -7; tenth <= 7; ++tenth) consider(coarse + 0.1 * tenth);
  smoother.Misfit(std::pow(10, best));
  return std::make_unique<Cubics>(smoother.Smooth());
}

}  // namespace hydro
