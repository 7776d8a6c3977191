// Values that are held until the next step.
#include <algorithm>
#include <cmath>

#include "model/trajectory/checks.h"
#include "model/trajectory/trajectory.h"

namespace hydro::trajectory {
namespace {

class Steps : public Trajectory {
 public:
  Steps(double initial, std::vector<Step> steps) : initial_(initial), steps_(std::move(steps)) {
    min_ = max_ = initial_;
    for (const Step& step : steps_) {
      min_ = std::min(min_, step.value);
      max_ = std::max(max_, step.value);
    }
  }

  double Value(double t) const override {
    const auto after = FirstAfter(t);
    return after == steps_.begin() ? initial_ : std::prev(after)->value;
  }
  double Rate(double) const override { return 0; }
  double NextBreak(double t) const override {
    const auto after = FirstAfter(t);
    return after == steps_.end() ? std::numeric_limits<double>::infinity() : after->time;
  }
  bool continuous() const override { return min_ == max_; }
  double Min() const override { return min_; }
  double Max() const override { return max_; }

 private:
  std::vector<Step>::const_iterator FirstAfter(double t) const {
    return std::upper_bound(steps_.begin(), steps_.end(), t,
                            [](double time, const Step& step) { return time < step.time; });
  }

  double initial_;
  std::vector<Step> steps_;
  double min_;
  double max_;
};

// A square wave.
class Square : public Trajectory {
 public:
  Square(double offset, double amplitude, double frequency_hz, double start)
      : offset_(offset), amplitude_(amplitude), frequency_(frequency_hz), start_(start) {}

  double Value(double t) const override {
    if (t < start_) return offset_;
    return std::fmod(Half(t), 2) == 0 ? offset_ + amplitude_ : offset_ - amplitude_;
  }
  double Rate(double) const override { return 0; }
  double NextBreak(double t) const override {
    if (t < start_) return start_;
    if (std::isinf(t)) return t;
    const double next = Edge(Half(t) + 1);
    // Where halves are shorter than the spacing of doubles, the next double is the nearest possible.
    return next > t ? next : std::nextafter(t, std::numeric_limits<double>::infinity());
  }
  bool continuous() const override { return amplitude_ == 0; }
  double Min() const override { return offset_ - std::abs(amplitude_); }
  double Max() const override { return offset_ + std::abs(amplitude_); }

 private:
  // Start of half period k. A sample taken "at" an edge may lie a rounding error before it. Edges are moved
  // forward in time by more than that error, so that they fall on the sample that a person expects.
  double Edge(double k) const {
    if (k == 0) return start_;
    const double since_start = k / (2 * frequency_);
    const double rounding =
        4 * std::numeric_limits<double>::epsilon() * std::max(std::abs(start_), since_start);
    return std::max(start_, start_ + since_start - rounding);
  }

  // The half period, counted from 0, in which t (not before the start) lies.
  double Half(double t) const {
    const double k = std::floor((t - start_) * 2 * frequency_);
    if (Edge(k + 1) <= t) return k + 1;
    return k > 0 && Edge(k) > t ? k - 1 : k;
  }

  double offset_;
  double amplitude_;
  double frequency_;
  double start_;
};

}  // namespace

std::unique_ptr<Trajectory> MakeSteps(double initial, std::vector<Step> steps) {
  RequireFinite("initial", initial);
  RequireIncreasing("step", steps);
  return std::make_unique<Steps>(initial, std::move(steps));
}

std::unique_ptr<Trajectory> MakeSquare(double offset, double amplitude, double frequency_hz, double start) {
  RequireFinite("offset", offset);
  RequireFinite("amplitude", amplitude);
  RequirePositive("frequency", frequency_hz);
  RequireFinite("start", start);
  RequireFinite("offset + amplitude", std::abs(offset) + std::abs(amplitude));
  return std::make_unique<Square>(offset, amplitude, frequency_hz, start);
}

}  // namespace hydro::trajectory
