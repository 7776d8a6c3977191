// The conditions under which an actuator runs, and its integrator.
#pragma once

#include <limits>

#include "model/trajectory/trajectory.h"

namespace hydro::model {

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

}  // namespace hydro::model
