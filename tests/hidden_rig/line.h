// A hydraulic line in pieces: volumes with inertia and resistance between them.
#pragma once

#include <array>

namespace hidden_rig {

inline constexpr int kPieces = 4;           // inertances
inline constexpr int kLineNodes = kPieces;  // volumes before the actuator's, the pump's first

struct Line {
  std::array<double, kLineNodes> volume{};  // in^3
  double fixed_volume = 0;                  // in^3, their sum: not at the actuator
  double inertance = 0;                     // psi s^2/in^3, of one piece
  double resistance = 0;                    // psi s/in^3, of one piece
};

// The line whose first resonance with the actuator at mid-stroke and the pump at rest is `hz`.
Line TuneLine(double hz, double pump_fraction, double damping, double mid_volume, double beta);

}  // namespace hidden_rig
