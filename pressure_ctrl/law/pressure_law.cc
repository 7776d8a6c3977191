#include "pressure_ctrl/law/pressure_law.h"

#include <cmath>
#include <stdexcept>
#include <string>

namespace hydro::pressure_ctrl {
namespace {

// Stiffness per rad of pump rotation, from eqs. (13) and (14).
struct Stiffness {
  double pressure = 0;  // psi/rad: the slope of dp, or of the load pressure with unequal sides
  double D = 0;         // in^3/rad: the pump torque that this pressure causes
};

Stiffness StiffnessAt(const model::Parameters& p, double arm_angle, int compressed_sides,
                      const model::Differences& differ) {
  if (compressed_sides != 1 && compressed_sides != 2) {
    throw std::invalid_argument("compressed sides: found " + std::to_string(compressed_sides) +
                                ", allowed are 1 and 2");
  }
  const double v1 = p.V_ms * (1 - differ.volumes) - p.c * (1 - differ.areas) * arm_angle;
  const double v2 = p.V_ms * (1 + differ.volumes) + p.c * (1 + differ.areas) * arm_angle;
  if (differ.areas == 0 && differ.displacements == 0)
    return {p.beta * p.D * (compressed_sides == 2 ? 1 / v1 + 1 / v2 : 1 / v2), p.D};
  const double D_1 = compressed_sides == 2 ? p.D * (1 - differ.displacements) : 0;
  const double D_2 = p.D * (1 + differ.displacements);
  const double pressure = p.beta * (D_1 * (1 - differ.areas) / v1 + D_2 * (1 + differ.areas) / v2);
  return {pressure, p.beta * (D_1 * D_1 / v1 + D_2 * D_2 / v2) / pressure};
}

}  // namespace

// With x = (dp, theta'): dp' = s theta', J theta'' = k_1 v - D dp - b theta', v from eq. (16). So
// omega^2 = s (D + k_1 k_p) / J and 2 zeta omega = (b + k_1 k_p k_v) / J.
PressureGains DerivePressureGains(const model::Parameters& p, double arm_angle, double natural_frequency,
                                  double damping_ratio, int compressed_sides,
                                  const model::Differences& differ) {
  const auto [stiffness, D] = StiffnessAt(p, arm_angle, compressed_sides, differ);
  PressureGains gains;
  gains.k_p = (natural_frequency * natural_frequency * p.J / stiffness - D) / p.k_1;
  if (!(gains.k_p > 0)) {
    throw std::invalid_argument("natural frequency: found " + std::to_string(natural_frequency) +
                                " rad/s, must be above the open loop's " +
                                std::to_string(std::sqrt(stiffness * D / p.J)) + " rad/s");
  }
  gains.k_v = (2 * damping_ratio * natural_frequency * p.J - p.b) / (p.k_1 * gains.k_p);
  return gains;
}

SecondOrder PressureLoopDynamics(const model::Parameters& p, double arm_angle, const PressureGains& gains,
                                 int compressed_sides, const model::Differences& differ) {
  const auto [stiffness, D] = StiffnessAt(p, arm_angle, compressed_sides, differ);
  SecondOrder loop;
  loop.natural_frequency = std::sqrt(stiffness * (D + p.k_1 * gains.k_p) / p.J);
  loop.damping_ratio = (p.b + p.k_1 * gains.k_p * gains.k_v) / (2 * p.J * loop.natural_frequency);
  return loop;
}

double SteadyStateFeedforward(const model::Parameters& p, const PressureGains& gains) {
  // rad/s per psi, from p_2' = 0 in eq. (14) with p_1 = p_3
  const double speed_per_psi = (p.c_I + p.c_E) / p.D;
  return (p.D + p.b * speed_per_psi) / p.k_1 + gains.k_p * gains.k_v * speed_per_psi;
}

}  // namespace hydro::pressure_ctrl
