// The fastest rest-to-rest move within the motor's torque and speed limits: full torque, then full braking.
#pragma once

#include "model/terms/description.h"

namespace hydro::design {

// Motor, pump and arm as one rigid body (incompressible fluid, no leakage), referred to the arm; eqs. (4),
// (15): (J (c/D)(k_2/D) + J_a) alpha'' = (k_2/D)(T_p - T_s sign(alpha') - b (c/D) alpha').
struct RigidDrive {
  double inertia = 0;   // lbf-in-s^2
  double torque = 0;    // in-lbf, the motor's largest
  double friction = 0;  // in-lbf, Coulomb; less than `torque`
  double viscous = 0;   // in-lbf-s
  double speed = 0;     // rad/s, limit
};

// motor_speed: the motor's largest speed, rad/s.
RigidDrive MakeRigidDrive(const model::Parameters& parameters, double motor_speed);

struct FastestMove {
  double time = 0;             // s, from rest to rest
  double switch_time = 0;      // s, until full braking begins
  double peak_speed = 0;       // rad/s
  bool speed_limited = false;  // part of the move runs at the speed limit
};

// Over `distance` > 0, rad.
FastestMove FastestRestToRest(const RigidDrive& drive, double distance);

// The shortest time, s, after which the arm stays within +/- band (a fraction of the distance) of the target.
// The arm may still be moving then, as fast as full braking can stop it within the band.
double FastestSettling(const RigidDrive& drive, double distance, double band);

}  // namespace hydro::design
