#include "model/terms/parameter_info.h"

#include "model/terms/model_error.h"

namespace hydro::model {

namespace {

BaseParameter NotNegative(double Parameters::*member, const char* name, const char* unit, const char* meaning,
                          int arm = 0) {
  return {{.name = name, .unit = unit, .meaning = meaning, .arm = arm}, member};
}

BaseParameter Positive(double Parameters::*member, const char* name, const char* unit, const char* meaning,
                       int arm = 0) {
  return {{.name = name, .unit = unit, .min_allowed = false, .meaning = meaning, .arm = arm}, member};
}

BaseParameter AnySign(double Parameters::*member, const char* name, const char* unit, const char* meaning,
                      int arm = 0) {
  return {{.name = name, .unit = unit, .min = -kUnbounded, .meaning = meaning, .arm = arm}, member};
}

}  // namespace

const std::vector<BaseParameter>& BaseParameters() {
  static const std::vector<BaseParameter> parameters = {
      Positive(&Parameters::k_1, "k_1", "in-lbf/V", "torque per volt of the amplifier, eq. (1)"),
      Positive(&Parameters::T_pmax, "T_pmax", "in-lbf", "limit of the motor torque set by the amplifier"),
      Positive(&Parameters::D, "D", "in^3/rad", "displacement of the pump, eq. (3)"),
      Positive(&Parameters::J, "J", "lbf-in-s^2", "inertia of motor and pump, eq. (4)"),
      NotNegative(&Parameters::b, "b", "in-lbf-s", "viscous friction of the pump, eq. (4)"),
      NotNegative(&Parameters::T_s, "T_s", "in-lbf", "Coulomb friction of the pump, eq. (4)"),
      NotNegative(&Parameters::f, "f", "in-lbf/psi", "Coulomb friction per pressure, eq. (4)"),
      Positive(&Parameters::beta, "beta", "psi", "bulk modulus of the fluid, eq. (5)"),
      Positive(&Parameters::V_ms, "V_ms", "in^3", "volume of one side at mid-stroke, eqs. (6), (7)"),
      Positive(&Parameters::c, "c", "in^3/rad", "displacement of the actuator, r^2 d/2, eqs. (6), (7)", -1),
      NotNegative(&Parameters::c_E, "c_E", "in^3/(s psi)",
                  "external leakage to the accumulator, eqs. (11), (12)"),
      NotNegative(&Parameters::c_I, "c_I", "in^3/(s psi)",
                  "internal leakage across the ports, eqs. (11), (12)"),
      NotNegative(&Parameters::p_3, "p_3", "psi", "pressure of the accumulator, eqs. (11), (12)"),
      Positive(&Parameters::k_2, "k_2", "in-lbf/psi", "torque on the arm per pressure difference, eq. (15)",
               -1),
      Positive(&Parameters::J_a, "J_a", "lbf-in-s^2", "inertia of the arm, eq. (15)", -2),
      AnySign(&Parameters::mgl, "mgl", "in-lbf", "gravity torque of the arm at alpha = 0, eq. (15)", -1),
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
