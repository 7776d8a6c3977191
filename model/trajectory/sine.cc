// A sine of one frequency, and one whose frequency changes.
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

// A sine whose frequency changes linearly with time; its phase is continuous throughout.
class Chirp : public Trajectory {
 public:
  Chirp(double offset, double amplitude, double first_hz, double last_hz, double start, double duration)
      : offset_(offset),
        amplitude_(amplitude),
        first_(first_hz),
        last_(last_hz),
        start_(start),
        duration_(duration) {}

  double Value(double t) const override {
    return t < start_ ? offset_ : offset_ + amplitude_ * std::sin(Angle(t - start_));
  }
  double Rate(double t) const override {
    if (t < start_) return 0;
    return 2 * M_PI * Frequency(t - start_) * amplitude_ * std::cos(Angle(t - start_));
  }
  double NextBreak(double t) const override {
    if (t < start_) return start_;
    return t < start_ + duration_ ? start_ + duration_ : std::numeric_limits<double>::infinity();
  }
  bool continuous() const override { return true; }
  double Min() const override { return offset_ - std::abs(amplitude_); }
  double Max() const override { return offset_ + std::abs(amplitude_); }

 private:
  double Frequency(double since_start) const {
    return since_start < duration_ ? first_ + (last_ - first_) * (since_start / duration_) : last_;
  }
  // The integral of the frequency, without whole periods.
  double Angle(double since_start) const {
    const double sweeping = std::min(since_start, duration_);
    const double cycles = sweeping * (first_ + (last_ - first_) * (sweeping / duration_) / 2) +
                          last_ * (since_start - sweeping);
    return 2 * M_PI * (cycles - std::floor(cycles));
  }

  double offset_;
  double amplitude_;
  double first_;
  double last_;
  double start_;
  double duration_;
};

void RequireFrequency(const std::string& what, double value) {
  RequireFinite(what, value);
  if (value < 0) RequirePositive(what, value);
}

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

std::unique_ptr<Trajectory> MakeChirp(double offset, double amplitude, double first_hz, double last_hz,
                                      double start, double duration) {
  RequireFinite("offset", offset);
  RequireFinite("amplitude", amplitude);
  RequireFrequency("first frequency", first_hz);
  RequirePositive("last frequency", last_hz);
  RequireFinite("start", start);
  RequirePositive("duration", duration);
  RequireFinite("offset + amplitude", std::abs(offset) + std::abs(amplitude));
  RequireFinite("rate", 2 * M_PI * std::max(first_hz, last_hz) * amplitude);
  return std::make_unique<Chirp>(offset, amplitude, first_hz, last_hz, start, duration);
}

}  // namespace hydro::trajectory
