#include "tune/live/reference_range.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/number_text.h"

namespace hydro::tuning {
namespace {

std::string Beyond(const std::string& what, double found, double allowed, const std::string& unit,
                   const std::string& why) {
  return "reference: found " + what + " of " + ShortNumber(found) + " " + unit + ", allowed " +
         ShortNumber(allowed) + " " + unit + " (" + why + ")";
}

// Per s, for the kinds that oscillate smoothly; 0 for others, because nothing follows their jumps at once
// anyway.
double FastestSwing(const settings::TrajectorySpec& spec) {
  using Kind = settings::TrajectorySpec::Kind;
  const double radian = 2 * std::numbers::pi * std::fabs(spec.amplitude);
  if (spec.kind == Kind::kSine) return radian * spec.frequency_hz;
  if (spec.kind == Kind::kChirp) return radian * std::max(spec.first_frequency_hz, spec.last_frequency_hz);
  return 0;
}

}  // namespace

std::string WhatTheRigCannotFollow(const settings::StackConfig& config) {
  const model::Parameters& p = config.model.description.parameters;
  const UnitSystem& units = config.model.description.units;
  const auto reference = settings::MakeTrajectory(config.reference.trajectory);
  const double largest = std::max(std::fabs(reference->Min()), std::fabs(reference->Max()));
  // The pressure that the motor holds against the pump at rest, or the limit of either side.
  const double pressure = std::min(p.T_pmax / p.D, config.limits.pressure_psi);
  switch (config.reference.signal) {
    case settings::ReferenceSignal::kArmAngle: {  // the configuration's own checks cover the angle
      const double speed = config.limits.motor_speed_rad_s * p.D / p.c;
      const double fastest = FastestSwing(config.reference.trajectory);
      if (fastest > speed)
        return Beyond("a speed", fastest, speed, units.UnitFor("rad/s", 1), "limits.motor_speed at the arm");
      return "";
    }
    case settings::ReferenceSignal::kPressure: {
      const double most = std::min(pressure, config.limits.arm_torque_in_lbf / p.k_2);
      if (largest > most) {
        return Beyond("a pressure", largest, most, units.UnitFor("psi"),
                      "T_pmax/D, limits.pressure and limits.arm_torque/k_2");
      }
      return "";
    }
    case settings::ReferenceSignal::kTorque: {
      const double torque = std::min(pressure * p.k_2, config.limits.arm_torque_in_lbf);
      if (largest > torque) {
        return Beyond(units.linear_arm ? "a force" : "a torque", largest, torque, units.UnitFor("in-lbf", -1),
                      "k_2 T_pmax/D and limits.arm_torque");
      }
      return "";
    }
    case settings::ReferenceSignal::kVoltage:
      if (largest > p.T_pmax / p.k_1)
        return Beyond("a voltage", largest, p.T_pmax / p.k_1, "V", "T_pmax/k_1");
      return "";
  }
  return "";
}

}  // namespace hydro::tuning
