// The pressure loop with waves in its lines as a polynomial, derived by hand: tests compare eigenvalues with
// it.
#pragma once

#include <array>
#include <numbers>

#include "model/terms/description.h"
#include "pressure_ctrl/law/pressure_law.h"

namespace hydro::design {

// For the difference of the two sides, at mid-stroke with both compressing and line.wave of this frequency
// (Hz), volume fraction and damping:
//   (J s + B) M(s) + D G(s) + k_1 k_p,  B = b + k_1 k_p k_v,
//   pump's per actuator's pressure  G = 1 + (I s^2 + R s)/c,
//   theta' per actuator's pressure  M = ((s + a L) G + a s/c)/(2 a D),
//   a = beta/V_p, c = beta/(V_ms - V_p), L = 2 c_I + c_E.
// Coefficient of s^i at [i].
inline std::array<double, 5> WavePolynomial(const model::Parameters& p, double frequency_hz,
                                            double volume_fraction, double damping,
                                            const pressure_ctrl::PressureGains& gains) {
  const double w = 2 * std::numbers::pi * frequency_hz;
  const double V_p = volume_fraction * p.V_ms;
  const double a = p.beta / V_p;
  const double c = p.beta / (p.V_ms - V_p);
  const double I = p.beta * (1 / V_p + 1 / (p.V_ms - V_p)) / (w * w);
  const double R = 2 * damping * I * w;
  const double L = 2 * p.c_I + p.c_E;
  const double B = p.b + p.k_1 * gains.k_p * gains.k_v;
  const double G[3] = {1, R / c, I / c};
  const double n = 1 / (2 * a * p.D);
  const double M[4] = {n * a * L * G[0], n * (G[0] + a * L * G[1] + a / c), n * (G[1] + a * L * G[2]),
                       n * G[2]};
  return {B * M[0] + p.D * G[0] + p.k_1 * gains.k_p, p.J * M[0] + B * M[1] + p.D * G[1],
          p.J * M[1] + B * M[2] + p.D * G[2], p.J * M[2] + B * M[3], p.J * M[3]};
}

// Routh's criterion for four roots; all coefficients are positive here.
inline bool RouthStable(const std::array<double, 5>& q) {
  return q[2] * q[3] > q[4] * q[1] && q[1] * q[2] * q[3] > q[4] * q[1] * q[1] + q[0] * q[3] * q[3];
}

}  // namespace hydro::design
