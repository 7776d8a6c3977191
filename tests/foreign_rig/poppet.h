// A valve whose poppet takes time to move, with the square-root flow of an orifice.
#pragma once

namespace foreign_rig {

struct Poppet {
  double opens_at = 0;      // psi across the valve
  double fully_open = 100;  // psi beyond opens_at
  double flow = 0;          // in^3/s/psi^.5 when fully open
  double time = 0.001;      // s
};

// Where the poppet would rest, 0 to 1.
double RestingLift(const Poppet& valve, double across);

// Flow at this lift; none against the valve's direction.
double PoppetFlow(const Poppet& valve, double lift, double across);

}  // namespace foreign_rig
