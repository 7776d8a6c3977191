#include "loops.h"

#include <algorithm>
#include <cmath>

namespace foreign_rig {

namespace {

constexpr double kConverterStep = 1.0 / 1024;  // V
constexpr double kLargestSpeed = 260;          // rad/s that the position loop asks for

}  // namespace

// Bandwidths follow the rate: a loop at 200 Hz is slower than one at 2 kHz.
Loops::Loops(const Plan& plan, const Values& v, double rate) : plan_(plan) {
  const double speed_bandwidth = std::min(70.0, rate / 10);
  const double pressure_bandwidth = std::min(80.0, rate / 10);  // rad/s
  speed_gain_ = v.rotor_inertia * speed_bandwidth / v.torque_per_volt;
  const double stiffness = v.displacement * v.displacement * 2 * v.bulk_modulus / v.mid_volume;
  pressure_gain_ = std::max(0.0, (v.rotor_inertia * pressure_bandwidth * pressure_bandwidth - stiffness) /
                                     stiffness * v.displacement / v.torque_per_volt);
  damping_ = 1.4 * v.rotor_inertia * pressure_bandwidth / v.torque_per_volt;
  position_gain_ = speed_bandwidth / 6;
  friction_volts_ = 0.7 * v.dry_torque / v.torque_per_volt;
  ratio_ = v.vane_volume / v.displacement;
  feed_forward_ = v.displacement / v.torque_per_volt;
}

double Loops::Volts(double t, const Reading& read) {
  while (at_ + 1 < plan_.stretches.size() && plan_.stretches[at_ + 1].start <= t + 1e-9) ++at_;
  const Stretch& stretch = plan_.stretches[at_];
  const double wanted = Wanted(stretch, t);
  double volts = wanted;
  if (stretch.goal == Goal::kPressure) {
    volts = pressure_gain_ * (wanted - (read.p2 - read.p1)) - damping_ * read.speed + feed_forward_ * wanted;
  } else if (stretch.goal != Goal::kVoltage) {
    double speed = wanted;
    if (stretch.goal == Goal::kAngle)
      speed = std::clamp(ratio_ * position_gain_ * (wanted - read.arm), -kLargestSpeed, kLargestSpeed);
    volts = speed_gain_ * (speed - read.speed) + friction_volts_ * std::tanh(speed / 8) +
            feed_forward_ * (read.p2 - read.p1);
  }
  return kConverterStep * std::round(std::clamp(volts, -kLargestVoltage, kLargestVoltage) / kConverterStep);
}

}  // namespace foreign_rig
