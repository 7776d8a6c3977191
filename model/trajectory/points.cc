// A signal through given points: held, joined by straight lines, or by monotone cubics.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "model/trajectory/checks.h"
#include "model/trajectory/trajectory.h"

namespace hydro::trajectory {
namespace {

// Slopes at the points that keep each cubic monotone between its two points: Fritsch and Carlson, SIAM J.
// Numer. Anal. 17 (1980). They are 0 at both ends, where the signal joins the constants outside with a
// continuous rate.
std::vector<double> MonotoneSlopes(const std::vector<Step>& points, const std::vector<double>& secants) {
  std::vector<double> slopes(points.size(), 0.0);
  for (size_t i = 1; i + 1 < points.size(); ++i) {
    const bool turns = secants[i - 1] == 0 || secants[i] == 0 || (secants[i - 1] > 0) != (secants[i] > 0);
    slopes[i] = turns ? 0 : secants[i - 1] / 2 + secants[i] / 2;
  }
  for (size_t i = 0; i < secants.size(); ++i) {
    if (secants[i] == 0) continue;
    const double excess = std::hypot(slopes[i] / secants[i], slopes[i + 1] / secants[i]) / 3;
    if (excess > 1) {
      slopes[i] /= excess;
      slopes[i + 1] /= excess;
    }
  }
  return slopes;
}

class Points : public Trajectory {
 public:
  Points(std::vector<Step> points, Interpolation interpolation)
      : points_(std::move(points)), interpolation_(interpolation) {
    min_ = max_ = points_.front().value;
    for (size_t i = 0; i < points_.size(); ++i) {
      min_ = std::min(min_, points_[i].value);
      max_ = std::max(max_, points_[i].value);
      if (i == 0) continue;
      const double secant =
          (points_[i].value - points_[i - 1].value) / (points_[i].time - points_[i - 1].time);
      if (interpolation_ != Interpolation::kHold && !std::isfinite(secant)) {
        throw std::invalid_argument(
            "point " + std::to_string(i + 1) +
            ": found a rate from the point before it that is not finite, allowed: a finite rate");
      }
      secants_.push_back(secant);
    }
    if (interpolation_ == Interpolation::kCubic) slopes_ = MonotoneSlopes(points_, secants_);
  }

  double Value(double t) const override {
    const size_t after = After(t);
    if (after == 0) return points_.front().value;
    const Step& from = points_[after - 1];
    if (after == points_.size() || interpolation_ == Interpolation::kHold) return from.value;
    const Step& to = points_[after];
    const double since = t - from.time;
    double value = from.value + secants_[after - 1] * since;
    if (interpolation_ == Interpolation::kCubic) {
      const double h = to.time - from.time;
      const double s = since / h;
      const double m0 = slopes_[after - 1], m1 = slopes_[after];
      const double rise = secants_[after - 1];
      // Hermite form about the first point: slope m0 there, m1 at the second.
      value = from.value + since * (m0 + s * ((3 * rise - 2 * m0 - m1) + s * (m0 + m1 - 2 * rise)));
    }
    // Rounding must not leave the range of the two points, because Min and Max are used to check a driven
    // shaft's volumes.
    return std::clamp(value, std::min(from.value, to.value), std::max(from.value, to.value));
  }

  double Rate(double t) const override {
    const size_t after = After(t);
    if (after == 0 || after == points_.size() || interpolation_ == Interpolation::kHold) return 0;
    const double rise = secants_[after - 1];
    if (interpolation_ == Interpolation::kLinear) return rise;
    const double s = (t - points_[after - 1].time) / (points_[after].time - points_[after - 1].time);
    const double m0 = slopes_[after - 1], m1 = slopes_[after];
    return m0 + s * (2 * (3 * rise - 2 * m0 - m1) + s * 3 * (m0 + m1 - 2 * rise));
  }

  double NextBreak(double t) const override {
    const size_t after = After(t);
    return after == points_.size() ? std::numeric_limits<double>::infinity() : points_[after].time;
  }
  bool continuous() const override { return interpolation_ != Interpolation::kHold || min_ == max_; }
  double Min() const override { return min_; }
  double Max() const override { return max_; }

 private:
  // Index of the first point after t.
  size_t After(double t) const {
    return std::upper_bound(points_.begin(), points_.end(), t,
                            [](double time, const Step& point) { return time < point.time; }) -
           points_.begin();
  }

  std::vector<Step> points_;
  Interpolation interpolation_;
  std::vector<double> secants_;  // mean rate from each point to the next
  std::vector<double> slopes_;   // rate at each point, cubic only
  double min_;
  double max_;
};

}  // namespace

std::unique_ptr<Trajectory> MakePoints(std::vector<Step> points, Interpolation interpolation) {
  if (points.empty()) throw std::invalid_argument("points: found none, allowed: one or more");
  RequireIncreasing("point", points);
  return std::make_unique<Points>(std::move(points), interpolation);
}

}  // namespace hydro::trajectory
