// What a signal of a rig can be at all. A reading beyond it is not believed, whatever the device says of it.
#pragma once

#include <limits>
#include <string>

#include "settings/driver_section.h"
#include "settings/stack_config.h"

namespace hydro::plant {

struct CredibleEnd {
  double value;      // in the signal's unit; infinite: there is no end
  std::string from;  // where it comes from: "driver.p1.maximum_V", "twice limits.pressure"
};

struct CredibleEnds {
  CredibleEnd low{-std::numeric_limits<double>::infinity(), ""};
  CredibleEnd high{std::numeric_limits<double>::infinity(), ""};
  std::string unit;

  bool Contain(double signal) const { return !(signal < low.value) && !(signal > high.value); }
  // Of the end that `signal` is beyond: "at most 4000 psi, twice limits.pressure".
  std::string Allowed(double signal) const;
};

// The ends of the signal `name` ("p1", "motor_speed", ...), which `section` describes. Each is the key
// minimum_V or maximum_V (minimum, maximum) where that is given. By default:
// - a pressure lies between a vacuum, less a tenth of limits.pressure, and twice limits.pressure (without
// that
//   limit, ten times beta, where the oil would be compressed to a fraction of its volume);
// - a motor speed is at most twice limits.motor_speed (without that limit, ten times T_pmax/b, the speed at
//   which friction takes the whole torque of the motor);
// - an arm angle is at most twice limits.arm_angle (without that limit, ten times V_ms/c, the stroke);
// - an arm speed is at most ten times the motor's largest credible speed times D/c: the oil between them is
//   compressible, and the rate of an angle is noisy;
// - an analog input of a board or front end is within +/-100 V: no converter has a wider range.
// Limits are those of the start.
CredibleEnds CredibleEndsOf(const settings::StackConfig& config, const std::string& name,
                            const settings::SensorSection& section);

}  // namespace hydro::plant
