// A sine whose frequency changes linearly with time; its phase is continuous throughout.
#include <algorithm>
#include <cmath>

#include "model/trajectory/checks.h"
#include "model/trajectory/trajectory.h"

namespace hydro::trajectory {
namespace {

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
