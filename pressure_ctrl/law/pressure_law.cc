#include "pressure_ctrl/law/pressure_law.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace hydro::pressure_ctrl {
namespace {

// psi per rad of pump rotation: how steeply dp rises with the pump's angle, from eqs. (13) and (14).
double PressureStiffness(const model::Parameters& p, double arm_angle, int compressed_sides) {
  if (compressed_sides != 1 && compressed_sides != 2) {
    throw std::invalid_argument("compressed sides: found " + std::to_string(compressed_sides) +
                                ", allowed are 1 and 2");
  }
  const double v1 = p.V_ms - p.c * arm_angle;
  const double v2 = p.V_ms + p.c * arm_angle;
  return p.beta * p.D * (compressed_sides == 2 ? 1 / v1 + 1 / v2 : 1 / v2);
}

}  // namespace

// With x = (dp, theta'): dp' = s theta', J theta'' = k_1 v - D dp - b theta', v from eq. (16). So
// omega^2 = s (D + k_1 k_p) / J and 2 zeta omega = (b + k_1 k_p k_v) / J.
PressureGains DerivePressureGains(const model::Parameters& p, double arm_angle, double natural_frequency,
                                  double damping_ratio, int compressed_sides) {
  const double stiffness = PressureStiffness(p, arm_angle, compressed_sides);
  PressureGains gains;
  gains.k_p = (natural_frequency * natural_frequency * p.J / stiffness - p.D) / p.k_1;
  if (!(gains.k_p > 0)) {
    throw std::invalid_argument("natural frequency: found " + std::to_string(natural_frequency) +
                                " rad/s, must be above the open loop's " +
                                std::to_string(std::sqrt(stiffness * p.D / p.J)) + " rad/s");
  }
  gains.k_v = (2 * damping_ratio * natural_frequency * p.J - p.b) / (p.k_1 * gains.k_p);
  return gains;
}

SecondOrder PressureLoopDynamics(const model::Parameters& p, double arm_angle, const PressureGains& gains,
                                 int compressed_sides) {
  const double stiffness = PressureStiffness(p, arm_angle, compressed_sides);
  SecondOrder loop;
  loop.natural_frequency = std::sqrt(stiffness * (p.D + p.k_1 * gains.k_p) / p.J);
  loop.damping_ratio = (p.b + p.k_1 * gains.k_p * gains.k_v) / (2 * p.J * loop.natural_frequency);
  return loop;
}

double SteadyStateFeedforward(const model::Parameters& p, const PressureGains& gains) {
  // rad/s per psi, from p_2' = 0 in eq. (14) with p_1 = p_3
  const double speed_per_psi = (p.c_I + p.c_E) / p.D;
  return (p.D + p.b * speed_per_psi) / p.k_1 + gains.k_p * gains.k_v * speed_per_psi;
}

}  // namespace hydro::pressure_ctrl
