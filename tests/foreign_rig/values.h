// The rig's own numbers, and how well each is known to those who write the model file.
//
// Units: in, lbf, s, psi, rad, V. Positive motor speed moves fluid from side 1 to side 2.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace foreign_rig {

struct Values {
  double torque_per_volt = 4.0, torque_limit = 40.0;
  double displacement = 0.00796, rotor_inertia = 0.03, viscous_torque = 0.01455, dry_torque = 4.0;
  double pressure_friction = 0;  // in-lbf/psi of p1 + p2
  double bulk_modulus = 247000, mid_volume = 3.16, vane_volume = 3.68;
  double outer_leakage = 6.5e-6, cross_leakage = 1e-6, supply_pressure = 100;
  double arm_torque = 3.68, arm_inertia = 23.3, arm_weight = 300;
};

// How well a number is known: the relative standard deviation of what a model file has.
inline constexpr double kGeometry = 0.01, kDataSheet = 0.05, kLoss = 0.20;

struct ValueForm {
  std::string name;  // in model files
  double Values::*value;
  double uncertainty;
};
const std::vector<ValueForm>& ValueForms();

// A rig of the paper's kind: each value within some tens of per cent of Table 1's.
Values DrawValues(uint64_t seed);

// What the model file says: each value off by its uncertainty, at most twice, at least by a fifth of it.
Values DrawGiven(const Values& values, uint64_t seed);

}  // namespace foreign_rig
