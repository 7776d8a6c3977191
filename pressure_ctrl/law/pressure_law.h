// The control law of the pressure loop, eq. (16), as pure functions.
#pragma once

#include <algorithm>

#include "model/sides.h"
#include "model/terms/description.h"

namespace hydro::pressure_ctrl {

struct PressureGains {
  double k_p = 0;  // V/psi
  double k_v = 0;  // psi s/rad
};

// The gains of eq. (16) that give the linearised pressure loop (eqs. (4), (13), (14) at the given arm angle,
// without leakage and Coulomb friction) the requested natural frequency (rad/s) and damping ratio.
// `compressed_sides` is 2 when both volumes compress, and 1 when side 1 is held at p_3 by its one-way valve.
// Throws std::invalid_argument when that needs k_p <= 0 (a natural frequency at or below the open loop's).
PressureGains DerivePressureGains(const model::Parameters& parameters, double arm_angle,
                                  double natural_frequency, double damping_ratio, int compressed_sides,
                                  const model::Differences& differ = {});

// The inverse of DerivePressureGains: the second-order loop that given gains produce.
struct SecondOrder {
  double natural_frequency = 0;  // rad/s
  double damping_ratio = 0;
};
SecondOrder PressureLoopDynamics(const model::Parameters& parameters, double arm_angle,
                                 const PressureGains& gains, int compressed_sides,
                                 const model::Differences& differ = {});

// V/psi: the feed-forward "which changes linearly with dp_ref" that removes the steady-state error of a
// clamped actuator up to Coulomb friction. It supplies the torque that holds dp_ref, D dp / k_1, and the
// cost, in viscous friction and in the k_v term, of the pump speed that replaces the leakage. One side is
// assumed to be at p_3.
double SteadyStateFeedforward(const model::Parameters& parameters, const PressureGains& gains);

// An actuator whose sides are unequal (model/sides.h): its load pressure (c_2 p2 - c_1 p1)/c takes the place
// of dp, and dp_ref is the wanted load pressure. All 0: the sides are equal.
struct UnequalSides {
  double areas = 0;          // model::Differences
  double displacements = 0;  // model::Differences
  double charge = 0;         // psi, p_3, the pressure of the side without load
};

struct PressureLawSettings {
  PressureGains gains;
  double voltage_limit = 0;          // V, T_pmax/k_1
  double reference_feedforward = 0;  // V/psi
  double arm_speed_ratio =
      0;  // c/D: subtracts the pump speed that arm motion forces from the k_v term; 0: off
  UnequalSides sides = {};
};

struct PressureLawInput {
  double pressure_ref = 0;  // psi, dp_ref
  double p1 = 0;            // psi
  double p2 = 0;            // psi
  double motor_speed = 0;   // rad/s
  double arm_speed = 0;     // rad/s, used only with arm_speed_ratio
  double transfer = 0;      // V, added: the remainder of the law before a change of gains
};

struct PressureLawOutput {
  double voltage = 0;      // V, within +/- voltage_limit
  bool saturated = false;  // the law asked for more
};

// The share of a load pressure that the pump, whose loaded side alone is above p_3, must supply: its pressure
// difference and, as a factor on c/D, its speed. When the sides are equal, the values are those of equal
// sides.
struct PumpShare {
  double pressure = 0;
  double speed = 1;
};

inline PumpShare ShareOf(const UnequalSides& sides, double load_pressure) {
  if (sides.areas == 0 && sides.displacements == 0) return {load_pressure, 1};
  const double above = load_pressure - 2 * sides.areas * sides.charge;
  const double side = above > 0 ? 1 : -1;
  const double ratio = (1 + side * sides.displacements) / (1 + side * sides.areas);
  return {above * ratio, 1 / ratio};
}

// Eq. (16) with the optional feed-forwards, V, without a limit:
//   v = k_p ((dp_ref - dp) - k_v (theta' - arm_speed_ratio alpha')) + reference_feedforward dp_ref + transfer
// With unequal sides, dp is the load pressure, and the feed-forwards act on the pump's share of dp_ref.
inline double UnlimitedPressureLaw(const PressureLawSettings& settings, const PressureLawInput& input) {
  const double pressure_error =
      input.pressure_ref - model::LoadPressure(settings.sides.areas, input.p1, input.p2);
  const PumpShare share = ShareOf(settings.sides, input.pressure_ref);
  double speed = input.motor_speed;
  if (settings.arm_speed_ratio != 0) speed -= settings.arm_speed_ratio * share.speed * input.arm_speed;
  const double voltage = settings.gains.k_p * (pressure_error - settings.gains.k_v * speed) +
                         settings.reference_feedforward * share.pressure;
  return input.transfer == 0 ? voltage : voltage + input.transfer;
}

// The same voltage, limited to +/- voltage_limit.
inline PressureLawOutput PressureLaw(const PressureLawSettings& settings, const PressureLawInput& input) {
  const double voltage = UnlimitedPressureLaw(settings, input);
  PressureLawOutput output;
  output.voltage = std::clamp(voltage, -settings.voltage_limit, settings.voltage_limit);
  output.saturated = output.voltage != voltage;
  return output;
}

}  // namespace hydro::pressure_ctrl
