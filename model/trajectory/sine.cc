// A sine of one frequency.
#include <algorithm>
#include <cmath>

#include "model/trajectory/checks.h"
#include "model/trajectory/trajectory.h"

namespace hydro::trajectory {
namespace {

class Sine : public Trajectory {
 public:
  Sine(double offset, double amplitude, double frequency_hz, double start, double phase_rad)
      : offset_(offset), amplitude_(amplitude), frequency_(frequency_hz), start_(start), phase_(phase_rad) {
    // A phase given as a rounded multiple of pi does not jump.
    const double rounding = 4 * std::numeric_limits<double>::epsilon() * std::max(1.0, std::abs(phase_));
    continuous_ = amplitude_ == 0 || std::abs(std::sin(phase_)) <= rounding;
  }

  double Value(double t) const override {
    return t < start_ ? offset_ : offset_ + amplitude_ * std::sin(Angle(t));
  }
  double Rate(double t) const override {
    if (t < start_ || (t == start_ && !continuous_)) return 0;
    return 2 * M_PI * frequency_ * amplitude_ * std::cos(Angle(t));
  }
  double NextBreak(double t) const override {
    return t < start_ ? start_ : std::numeric_limits<double>::infinity();
  }
  bool continuous() const override { return continuous_; }
  double Min() const override { return offset_ - std::abs(amplitude_); }
  double Max() const override { return offset_ + std::abs(amplitude_); }

 private:
  double Angle(double t) const {
    // Whole periods are dropped before the sine is taken, so that it stays as exact after a long time.
    const double cycles = frequency_ * (t - start_);
    return 2 * M_PI * (cycles - std::floor(cycles)) + phase_;
  }

  double offset_;
  double amplitude_;
  double frequency_;
  double start_;
  double phase_;
  bool continuous_;
};

}  // namespace

std::unique_ptr<Trajectory> MakeSine(double offset, double amplitude, double frequency_hz, double start,
                                     double phase_rad) {
  RequireFinite("offset", offset);
  RequireFinite("amplitude", amplitude);
  RequirePositive("frequency", frequency_hz);
  RequireFinite("start", start);
  RequireFinite("phase", phase_rad);
  RequireFinite("offset + amplitude", std::abs(offset) + std::abs(amplitude));
  RequireFinite("rate", 2 * M_PI * frequency_hz * amplitude);
  return std::make_unique<Sine>(offset, amplitude, frequency_hz, start, phase_rad);
}

}  // namespace hydro::trajectory
