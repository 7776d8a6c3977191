// Friction as the bending of bristles between two surfaces.
//
// Canudas de Wit et al. 1995 (LuGre), with the elastic range of Dupont et al. 2002, so that a body that is
// pushed back and forth below its limit does not creep.
#pragma once

namespace foreign_rig {

struct Bristles {
  double stiffness = 1;      // force per bend
  double damping = 0;        // force per rate of bend, at rest
  double damping_speed = 1;  // above which the bristles no longer damp
  double elastic_part = 0;   // of the bend at full slip, below which nothing slips
};

// How much of the motion slips: 0 below the elastic range, 1 at full slip.
double SlipShare(const Bristles& b, double bend, double speed, double limit);

// Force of the bristles at this speed, without viscous friction.
double BristleForce(const Bristles& b, double bend, double speed, double limit);

// The bend a time `h` later at constant speed and share of slip: exact, since bristles are too stiff for a
// step. `limit` is the force at steady slip.
double Bend(const Bristles& b, double bend, double speed, double limit, double h);

}  // namespace foreign_rig
