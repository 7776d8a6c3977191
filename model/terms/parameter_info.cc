#include "model/terms/parameter_info.h"

#include "model/terms/model_error.h"

namespace hydro::model {

const std::vector<BaseParameter>& BaseParameters() {
  static const std::vector<BaseParameter> parameters = {
      {{.name = "k_1",
        .unit = "in-lbf/V",
        .min = 0,
        .min_allowed = false,
        .meaning = "torque per volt of the amplifier, eq. (1)"},
       &Parameters::k_1},
      {{.name = "T_pmax",
        .unit = "in-lbf",
        .min = 0,
        .min_allowed = false,
        .meaning = "limit of the motor torque set by the amplifier"},
       &Parameters::T_pmax},
      {{.name = "D",
        .unit = "in^3/rad",
        .min = 0,
        .min_allowed = false,
        .meaning = "displacement of the pump, eq. (3)"},
       &Parameters::D},
      {{.name = "J",
        .unit = "lbf-in-s^2",
        .min = 0,
        .min_allowed = false,
        .meaning = "inertia of motor and pump, eq. (4)"},
       &Parameters::J},
      {{.name = "b", .unit = "in-lbf-s", .meaning = "viscous friction of the pump, eq. (4)"}, &Parameters::b},
      {{.name = "T_s", .unit = "in-lbf", .meaning = "Coulomb friction of the pump, eq. (4)"},
       &Parameters::T_s},
      {{.name = "f", .unit = "in-lbf/psi", .meaning = "Coulomb friction per pressure, eq. (4)"},
       &Parameters::f},
      {{.name = "beta",
        .unit = "psi",
        .min = 0,
        .min_allowed = false,
        .meaning = "bulk modulus of the fluid, eq. (5)"},
       &Parameters::beta},
      {{.name = "V_ms",
        .unit = "in^3",
        .min = 0,
        .min_allowed = false,
        .meaning = "volume of one side at mid-stroke, eqs. (6), (7)"},
       &Parameters::V_ms},
      {{.name = "c",
        .unit = "in^3/rad",
        .min = 0,
        .min_allowed = false,
        .meaning = "displacement of the actuator, r^2 d/2, eqs. (6), (7)"},
       &Parameters::c},
      {{.name = "c_E",
        .unit = "in^3/(s psi)",
        .meaning = "external leakage to the accumulator, eqs. (11), (12)"},
       &Parameters::c_E},
      {{.name = "c_I",
        .unit = "in^3/(s psi)",
        .meaning = "internal leakage across the ports, eqs. (11), (12)"},
       &Parameters::c_I},
      {{.name = "p_3", .unit = "psi", .meaning = "pressure of the accumulator, eqs. (11), (12)"},
       &Parameters::p_3},
      {{.name = "k_2",
        .unit = "in-lbf/psi",
        .min = 0,
        .min_allowed = false,
        .meaning = "torque on the arm per pressure difference, eq. (15)"},
       &Parameters::k_2},
      {{.name = "J_a",
        .unit = "lbf-in-s^2",
        .min = 0,
        .min_allowed = false,
        .meaning = "inertia of the arm, eq. (15)"},
       &Parameters::J_a},
      {{.name = "mgl",
        .unit = "in-lbf",
        .min = -kUnbounded,
        .meaning = "gravity torque of the arm at alpha = 0, eq. (15)"},
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
