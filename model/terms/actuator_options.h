// The conditions under which an actuator runs, the load on its arm, and its integrator.
#pragma once

#include <limits>

#include "model/trajectory/trajectory.h"

namespace hydro::model {

// The conditions under which an actuator runs, and its integrator.

// What holds the actuator's shaft.
enum class Shaft { kFree, kClamped, kDriven };

// The integrator of the equations between events.
enum class Integrator {
  kAuto,   // kFast while the mode is not stiff, else kCvode
  kFast,   // classical Runge-Kutta with an error estimate, this project's own
  kErk,    // SUNDIALS ARKODE ERKStep, an explicit embedded pair
  kCvode,  // SUNDIALS CVODE, BDF with the exact Jacobian
};

struct ActuatorOptions {
  Shaft shaft = Shaft::kFree;
  double arm_angle = 0;  // rad; clamped: the arm's position; free: its initial position
  // rad over s; driven: the arm's angle. Must be continuous and outlive the model.
  const trajectory::Trajectory* motion = nullptr;
  bool bypass = false;                                                 // the two sides are connected: p1 = p2
  double initial_pressure = std::numeric_limits<double>::quiet_NaN();  // psi, both sides; NaN: p_3
  Integrator integrator = Integrator::kAuto;
  double relative_tolerance = 1e-8;
  // s, the zero of the effects' t: a simulation may begin in the middle of a run.
  double begin = 0;
  // An effect may appear more than once. Derivatives by several effects of size zero need this.
  bool repeated_effects = false;
};

// The load that an arm puts on its actuator when it is part of something larger.

// Replaces J_a and -mgl cos(alpha) of eq. (15): inertia alpha'' = k_2 dp + torque + torque_rate s +
// torque_curve s^2, with s the time since the load was set.
struct ArmLoad {
  double inertia = 0;       // in-lbf-s^2, above 0
  double torque = 0;        // in-lbf, in the direction of alpha
  double torque_rate = 0;   // in-lbf/s
  double torque_curve = 0;  // in-lbf/s^2
};

}  // namespace hydro::model
