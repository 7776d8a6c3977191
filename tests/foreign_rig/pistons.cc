#include "pistons.h"

#include <cmath>
#include <numbers>

namespace foreign_rig {

// For an odd number z, the sum of the half sines is cos(u)/(2 sin(pi/2z)) with u the angle from the nearest
// top, |u| <= pi/2z; its mean is z/pi (Ivantysyn and Ivantysynova 2001).
double PistonPulse(int pistons, double angle) {
  const double period = std::numbers::pi / pistons;
  const double u = angle - period * std::round(angle / period);
  return std::cos(u) * std::numbers::pi / (2 * pistons * std::sin(std::numbers::pi / (2 * pistons)));
}

double PulseAmplitude(int pistons) {
  const double n = 2.0 * pistons;
  return 2 / (n * n - 1);
}

}  // namespace foreign_rig
