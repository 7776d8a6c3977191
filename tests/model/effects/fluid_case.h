// What the tests of effects on the fluid's bulk modulus share.
#pragma once

#include <functional>

namespace hydro::testing {

// Time in which the external leakage c_E takes both sides from `high` to `low`: the integral of V dp over
// beta(p) c_E (p - p_3), by Simpson's rule.
inline double TimeToFall(double high, double low, double c_E, const std::function<double(double)>& beta) {
  const int steps = 2000;
  double time = 0;
  for (int i = 0; i <= steps; ++i) {
    const double p = low + (high - low) * i / steps;
    const double weight = i == 0 || i == steps ? 1 : i % 2 == 1 ? 4 : 2;
    time += weight * 3.16 / (beta(p) * c_E * (p - 100)) * (high - low) / steps / 3;
  }
  return time;
}

}  // namespace hydro::testing
