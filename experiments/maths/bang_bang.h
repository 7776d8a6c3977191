// The fastest rest-to-rest move that the motor's torque and speed allow: full torque, then full braking.
#pragma once

#include "model/terms/description.h"

namespace hydro::experiments {

// Motor, pump and arm as one rigid body (incompressible fluid, no leakage), seen at the arm; eqs. (4), (15):
// (J (c/D)(k_2/D) + J_a) alpha'' = (k_2/D)(T_p - T_s sign(alpha') - b (c/D) alpha').
struct RigidDrive {
  double inertia = 0;   // lbf-in-s^2
  double torque = 0;    // in-lbf, largest of the motor
  double friction = 0;  // in-lbf, Coulomb; less than `torque`
  double viscous = 0;   // in-lbf-s
  double speed = 0;     // rad/s, largest
};

// motor_speed: rad/s, the largest of the motor.
RigidDrive MakeRigidDrive(const model::Parameters& parameters, double motor_speed);

struct FastestMove {
  double time = 0;             // s, from rest to rest
  double switch_time = 0;      // s, until full braking begins
  double peak_speed = 0;       // rad/s
  bool speed_limited = false;  // a part of it goes at the speed limit
};

// Over `distance` > 0, rad.
FastestMove FastestRestToRest(const RigidDrive& drive, double distance);

// s: the shortest time to come within +/- band (a fraction of the distance) of the target and never leave it
// again: the arm may still move then, as fast as full braking can stop it within the band.
double FastestSettling(const RigidDrive& drive, double distance, double band);

}  // namespace hydro::experiments
