#include "fluid.h"

#include <algorithm>
#include <cmath>

namespace foreign_rig {

namespace {

// ln(viscosity) = A + kB/(T + kC), for 46 cSt at 40 degrees C and 6.8 cSt at 100.
constexpr double kB = 838.7, kC = 95.0;

}  // namespace

double RelativeViscosity(double celsius) { return std::exp(kB / (celsius + kC) - kB / (40 + kC)); }
double ViscositySlope(double celsius) { return -kB / ((celsius + kC) * (celsius + kC)); }

double FreeAir(double total, double p, double all_dissolved) {
  return total * std::clamp(1 - p / all_dissolved, 0.0, 1.0);
}

double AirCompressibility(double free, double p) {
  const double absolute = std::max(p, -0.9 * kAtmosphere) + kAtmosphere;
  return free * kAtmosphere / (absolute * absolute);
}

double HoseModulus(double at_rest, double slope, double knee, double p) {
  if (slope == 0) return at_rest;
  return at_rest + slope * knee * (1 - std::exp(-std::max(p, 0.0) / knee));
}

}  // namespace foreign_rig
