#include "model/terms/parameter_info.h"

#include <limits>

#include "model/terms/model_error.h"

namespace hydro::model {

const std::vector<BaseParameter>& BaseParameters() {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  static const std::vector<BaseParameter> parameters = {
      {{"k_1", "in-lbf/V", 0, kInf, false, "torque per volt of the amplifier, eq. (1)"}, &Parameters::k_1},
      {{"T_pmax", "in-lbf", 0, kInf, false, "limit of the motor torque set by the amplifier"},
       &Parameters::T_pmax},
      {{"D", "in^3/rad", 0, kInf, false, "displacement of the pump, eq. (3)"}, &Parameters::D},
      {{"J", "lbf-in-s^2", 0, kInf, false, "inertia of motor and pump, eq. (4)"}, &Parameters::J},
      {{"b", "in-lbf-s", 0, kInf, true, "viscous friction of the pump, eq. (4)"}, &Parameters::b},
      {{"T_s", "in-lbf", 0, kInf, true, "Coulomb friction of the pump, eq. (4)"}, &Parameters::T_s},
      {{"f", "in-lbf/psi", 0, kInf, true, "Coulomb friction per pressure, eq. (4)"}, &Parameters::f},
      {{"beta", "psi", 0, kInf, false, "bulk modulus of the fluid, eq. (5)"}, &Parameters::beta},
      {{"V_ms", "in^3", 0, kInf, false, "volume of one side at mid-stroke, eqs. (6), (7)"},
       &Parameters::V_ms},
      {{"c", "in^3/rad", 0, kInf, false, "displacement of the actuator, r^2 d/2, eqs. (6), (7)"},
       &Parameters::c},
      {{"c_E", "in^3/(s psi)", 0, kInf, true, "external leakage to the accumulator, eqs. (11), (12)"},
       &Parameters::c_E},
      {{"c_I", "in^3/(s psi)", 0, kInf, true, "internal leakage across the ports, eqs. (11), (12)"},
       &Parameters::c_I},
      {{"p_3", "psi", 0, kInf, true, "pressure of the accumulator, eqs. (11), (12)"}, &Parameters::p_3},
      {{"k_2", "in-lbf/psi", 0, kInf, false, "torque on the arm per pressure difference, eq. (15)"},
       &Parameters::k_2},
      {{"J_a", "lbf-in-s^2", 0, kInf, false, "inertia of the arm, eq. (15)"}, &Parameters::J_a},
      {{"mgl", "in-lbf", -kInf, kInf, true, "gravity torque of the arm at alpha = 0, eq. (15)"},
       &Parameters::mgl},
  };
  return parameters;
}

size_t BasePlace(const std::string& name) {
  for (size_t i = 0; i < BaseParameters().size(); ++i) {
    if (BaseParameters()[i].info.name == name) return i;
  }
  throw ModelError("no base parameter is called \"" + name + "\"");
}

}  // namespace hydro::model
