// The load that an arm puts on its actuator when it is part of something larger.
#pragma once

namespace hydro::model {

// Replaces J_a and -mgl cos(alpha) of eq. (15): inertia alpha'' = k_2 dp + torque + torque_rate s +
// torque_curve s^2, with s the time since the load was set.
struct ArmLoad {
  double inertia = 0;       // in-lbf-s^2, above 0
  double torque = 0;        // in-lbf, in the direction of alpha
  double torque_rate = 0;   // in-lbf/s
  double torque_curve = 0;  // in-lbf/s^2
};

}  // namespace hydro::model
