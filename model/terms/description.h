// A model as data: the paper's base parameters and the effects added to its equations.
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "base/unit_system.h"

namespace hydro::model {

class EffectFormulas;

// Base parameters of eqs. (1) to (15), Table 1. Units only need to be coherent; the comments give the
// paper's. T is double, or a scalar with derivatives.
template <class T>
struct ParametersOf {
  T k_1{};     // in-lbf/V, torque per volt, eq. (1)
  T T_pmax{};  // in-lbf, limit of |T_p| set by the amplifier's current limit
  T D{};       // in^3/rad, pump displacement, eq. (3)
  T J{};       // lbf-in-s^2, inertia of motor and pump, eq. (4)
  T b{};       // in-lbf-s, viscous friction, eq. (4)
  T T_s{};     // in-lbf, Coulomb friction, eq. (4)
  T f{};       // in-lbf/psi, Coulomb friction per pressure, eq. (4)
  T beta{};    // psi, bulk modulus, eq. (5)
  T V_ms{};    // in^3, volume of one side at mid-stroke, eqs. (6), (7)
  T c{};       // in^3/rad, displacement of the actuator, r^2 d/2 in eqs. (6), (7)
  T c_E{};     // in^3/(s psi), external leakage to the accumulator, eqs. (11), (12)
  T c_I{};     // in^3/(s psi), internal leakage across the ports, eqs. (11), (12)
  T p_3{};     // psi, accumulator pressure
  T k_2{};     // in-lbf/psi, arm torque per pressure difference, eq. (15)
  T J_a{};     // lbf-in-s^2, inertia of the arm, eq. (15)
  T mgl{};     // in-lbf, gravity torque of the arm at alpha = 0, eq. (15); linear arm: weight along its path
};
using Parameters = ParametersOf<double>;

// One of the model's effects, as written in its file: [effects."id"].
struct EffectDescription {
  std::string id;                            // as in docs/effects.md
  std::map<std::string, double> parameters;  // name -> value
  std::map<std::string, std::string> names;  // parameters whose value is a name (a signal)
  // Parameters whose value is a list of numbers or of names.
  std::map<std::string, std::vector<double>> lists = {};
  std::map<std::string, std::vector<std::string>> name_lists = {};
  // The formulas of an effect that is written as text in the model's file; null: the catalogue has the
  // effect.
  std::shared_ptr<const EffectFormulas> formulas = nullptr;
};

struct ModelDescription {
  std::string name;
  Parameters parameters;
  std::vector<EffectDescription> effects;  // in the file's order
  UnitSystem units = {};                   // of all values; the equations need the arm's
  // How well base parameters are known, where stated: name -> relative standard deviation. Fits use it; the
  // equations do not.
  std::map<std::string, double> uncertainty = {};
};

// The pressure of the surrounding air, from which a model's pressures count, in its unit.
double AtmosphereOf(const ModelDescription& model);

// Machines that a model allows: base parameters drawn at random, with deviations as large as their
// uncertainty.

// Model number `index` of those that `seed` draws from the uncertainty of `known`. Each base parameter is its
// value times exp(s z), where z is its DrawnDeviation() and s its UncertaintyOf(). [uncertainty] has the same
// meaning in a fit (diagnose/fit/prior.h): the value is the median, and s is the standard deviation of its
// logarithm, to first order the relative one. Signs and bounds therefore stay, and a value given as 0 stays
// 0. The parameters are independent: c is one parameter, though a file may give it by r and d, and k_2 is
// another. Effects, units, [uncertainty] and the name do not change.
ModelDescription DrawnModel(const ModelDescription& known, uint64_t seed, uint64_t index);

// Standard normal. The number depends only on these three arguments, not on what else is drawn, in which
// order, or on which thread. Its bits are the same wherever the C library computes log and cos alike (for
// DrawnModel also exp).
double DrawnDeviation(uint64_t seed, uint64_t index, std::string_view parameter);

// Moves base parameter `base` (an index in BaseParameters()) by `deviations` of its standard deviations, as
// above, but by no more than a factor of 10^6, so that the value stays finite whatever [uncertainty] says.
void Deviate(ModelDescription* model, size_t base, double deviations);

}  // namespace hydro::model
