#include "pistons.h"

#include <cmath>

namespace foreign_rig {

namespace {

constexpr double kPi = 3.14159265358979323846;

}  // namespace

// For an odd number z, the sum of the half sines is cos(u)/(2 sin(pi/2z)) with u the angle from the nearest
// top, |u| <= pi/2z; its mean is z/pi (Ivantysyn and Ivantysynova 2001).
double PistonPulse(int pistons, double angle) {
  const double period = kPi / pistons;
  const double u = angle - period * std::round(angle / period);
  return std::cos(u) * kPi / (2 * pistons * std::sin(kPi / (2 * pistons)));
}

double PulseAmplitude(int pistons) {
  const double n = 2.0 * pistons;
  return 2 / (n * n - 1);
}

}  // namespace foreign_rig
