#include "values.h"

#include <algorithm>
#include <cmath>

#include "draw.h"

namespace foreign_rig {

const std::vector<ValueForm>& ValueForms() {
  static const std::vector<ValueForm> forms = {
      {"k_1", &Values::torque_per_volt, kDataSheet}, {"T_pmax", &Values::torque_limit, kDataSheet},
      {"D", &Values::displacement, kGeometry},       {"J", &Values::rotor_inertia, kDataSheet},
      {"b", &Values::viscous_torque, kLoss},         {"T_s", &Values::dry_torque, kLoss},
      {"f", &Values::pressure_friction, kLoss},      {"beta", &Values::bulk_modulus, kDataSheet},
      {"V_ms", &Values::mid_volume, kGeometry},      {"c", &Values::vane_volume, kGeometry},
      {"c_E", &Values::outer_leakage, kLoss},        {"c_I", &Values::cross_leakage, kLoss},
      {"p_3", &Values::supply_pressure, kDataSheet}, {"k_2", &Values::arm_torque, kGeometry},
      {"J_a", &Values::arm_inertia, kDataSheet},     {"mgl", &Values::arm_weight, kDataSheet},
  };
  return forms;
}

Values DrawValues(uint64_t seed) {
  Draw draw(seed, "values");
  const auto about = [&](double value, double part) { return value * std::exp(part * draw.Between(-1, 1)); };
  Values v;
  v.torque_per_volt = about(4.0, 0.15);
  v.torque_limit = about(40, 0.15);
  v.displacement = about(0.00796, 0.15);
  v.rotor_inertia = about(0.03, 0.25);
  v.viscous_torque = about(0.01455, 0.3);
  v.dry_torque = about(4.0, 0.3);
  v.bulk_modulus = about(230000, 0.2);
  v.mid_volume = about(3.4, 0.15);
  v.vane_volume = about(3.68, 0.08);
  v.outer_leakage = about(6.5e-6, 0.5);
  v.cross_leakage = about(2e-6, 0.7);
  v.supply_pressure = about(100, 0.25);
  v.arm_torque = v.vane_volume * draw.Between(0.97, 1.0);  // the vane's seals take the rest
  v.arm_inertia = about(23.3, 0.3);
  v.arm_weight = about(260, 0.5);
  return v;
}

Values DrawGiven(const Values& values, uint64_t seed) {
  Draw draw(seed, "given");
  Values given = values;
  for (const ValueForm& form : ValueForms()) {
    const double off = std::clamp(std::abs(draw.Normal()), 0.2, 2.0) * form.uncertainty;
    given.*form.value *= 1 + draw.Sign() * std::min(off, 0.3);
  }
  return given;
}

}  // namespace foreign_rig
