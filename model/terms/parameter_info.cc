#include "model/terms/parameter_info.h"

#include <cmath>
#include <optional>

#include "base/number_text.h"
#include "base/units.h"
#include "model/terms/model_error.h"

namespace hydro::model {

namespace {

// Relative uncertainty of a parameter before its rig is measured.
constexpr double kGeometry = 0.01;
constexpr double kDataSheet = 0.05;
constexpr double kFriction = 0.3;  // friction, leakage, damping

struct Meaning {
  const char* name;
  const char* unit;
  const char* text;
  double example;  // of Table 1, or of a similar machine where Table 1 has none
  int arm = 0;
};

BaseParameter NotNegative(double Parameters::*member, double uncertainty, const Meaning& meaning) {
  return {{.name = meaning.name,
           .unit = meaning.unit,
           .meaning = meaning.text,
           .arm = meaning.arm,
           .example = meaning.example},
          member,
          uncertainty};
}

BaseParameter Positive(double Parameters::*member, double uncertainty, const Meaning& meaning) {
  BaseParameter parameter = NotNegative(member, uncertainty, meaning);
  parameter.info.min_allowed = false;
  return parameter;
}

BaseParameter AnySign(double Parameters::*member, double uncertainty, const Meaning& meaning) {
  BaseParameter parameter = NotNegative(member, uncertainty, meaning);
  parameter.info.min = -kUnbounded;
  return parameter;
}

// A value that is unusual, and by how many powers of ten.
struct Outlier {
  double decades = 3;
  std::string text;
};

void Compare(const ParameterInfo& info, const UnitSystem& units, const std::string& owner, double value,
             Outlier* most) {
  const std::string unit = info.UnitIn(units);
  const std::optional<Unit> paper = ParseUnit(info.unit), own = ParseUnit(unit);
  const double usual = paper && own ? info.example * paper->size / own->size : info.example;
  if (value == 0 || usual == 0 || !std::isfinite(value)) return;
  const double decades = std::log10(std::fabs(value / usual));
  const bool small_is_none = info.min < 0 || (info.min == 0 && info.min_allowed);
  if ((small_is_none && decades < 0) || !(std::fabs(decades) > most->decades)) return;
  most->decades = std::fabs(decades);
  most->text = owner + info.name + " = " + ShortestNumber(value) + (unit == "1" ? "" : " " + unit) +
               ", where " + ShortNumber(usual, 2) + " is usual";
}

}  // namespace

Standard::Standard(double value)
    : text_(ShortestNumber(value)),
      number_([value](const ParametersOf<double>& /*base*/) { return value; }),
      jet_([value](const ParametersOf<Jet>& /*base*/) { return Jet(value); }) {}

double NumberOf(const EffectDescription& effect, const ParameterInfo& number, const Parameters& base) {
  const auto stated = effect.parameters.find(number.name);
  if (stated != effect.parameters.end()) return stated->second;
  if (!number.optional) throw ModelError("parameter " + effect.id + "." + number.name + " is missing");
  return number.standard.In(base);
}

const std::vector<BaseParameter>& BaseParameters() {
  static const std::vector<BaseParameter> parameters = {
      Positive(&Parameters::k_1, kDataSheet,
               {"k_1", "in-lbf/V", "torque per volt of the amplifier, eq. (1)", 4}),
      Positive(&Parameters::T_pmax, kDataSheet,
               {"T_pmax", "in-lbf", "limit of the motor torque set by the amplifier", 40}),
      Positive(&Parameters::D, kDataSheet, {"D", "in^3/rad", "displacement of the pump, eq. (3)", 0.00796}),
      Positive(&Parameters::J, kDataSheet, {"J", "lbf-in-s^2", "inertia of motor and pump, eq. (4)", 0.03}),
      NotNegative(&Parameters::b, kFriction,
                  {"b", "in-lbf-s", "viscous friction of the pump, eq. (4)", 0.01455}),
      NotNegative(&Parameters::T_s, kFriction, {"T_s", "in-lbf", "Coulomb friction of the pump, eq. (4)", 4}),
      NotNegative(&Parameters::f, kFriction,
                  {"f", "in-lbf/psi", "Coulomb friction per pressure, eq. (4)", 0.001}),
      Positive(&Parameters::beta, kDataSheet, {"beta", "psi", "bulk modulus of the fluid, eq. (5)", 247000}),
      Positive(&Parameters::V_ms, kGeometry,
               {"V_ms", "in^3", "volume of one side at mid-stroke, eqs. (6), (7)", 3.16}),
      Positive(&Parameters::c, kGeometry,
               {"c", "in^3/rad", "displacement of the actuator, r^2 d/2, eqs. (6), (7)", 3.68, -1}),
      NotNegative(&Parameters::c_E, kFriction,
                  {"c_E", "in^3/(s psi)", "external leakage to the accumulator, eqs. (11), (12)", 6.5e-6}),
      NotNegative(&Parameters::c_I, kFriction,
                  {"c_I", "in^3/(s psi)", "internal leakage across the ports, eqs. (11), (12)", 1e-6}),
      NotNegative(&Parameters::p_3, kDataSheet,
                  {"p_3", "psi", "pressure of the accumulator, eqs. (11), (12)", 100}),
      Positive(&Parameters::k_2, kDataSheet,
               {"k_2", "in-lbf/psi", "torque on the arm per pressure difference, eq. (15)", 3.68, -1}),
      Positive(&Parameters::J_a, kDataSheet, {"J_a", "lbf-in-s^2", "inertia of the arm, eq. (15)", 23.3, -2}),
      AnySign(&Parameters::mgl, kDataSheet,
              {"mgl", "in-lbf", "gravity torque of the arm at alpha = 0, eq. (15); a linear arm's weight",
               562, -1}),
  };
  return parameters;
}

std::string MostUnusual(const ModelDescription& model) {
  Outlier most;
  for (const BaseParameter& base : BaseParameters())
    Compare(base.info, model.units, "", model.parameters.*base.member, &most);
  for (const EffectDescription& effect : model.effects) {
    const EffectInfo* known = FindEffect(effect);
    if (known == nullptr) continue;
    for (const ParameterInfo& info : known->parameters) {
      const auto value = effect.parameters.find(info.name);
      if (value != effect.parameters.end()) Compare(info, model.units, effect.id + ".", value->second, &most);
    }
  }
  return most.text;
}

size_t BasePlace(const std::string& name) {
  for (size_t i = 0; i < BaseParameters().size(); ++i) {
    if (BaseParameters()[i].info.name == name) return i;
  }
  throw ModelError("no base parameter is called \"" + name + "\"");
}

double UncertaintyOf(const ModelDescription& model, size_t base) {
  const BaseParameter& parameter = BaseParameters()[base];
  const auto stated = model.uncertainty.find(parameter.info.name);
  return stated == model.uncertainty.end() ? parameter.uncertainty : stated->second;
}

}  // namespace hydro::model
