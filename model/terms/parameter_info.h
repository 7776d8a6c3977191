// What is known of each parameter by itself: name, unit, physical bounds, meaning. Model files are checked
// against it, reports print it.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "model/terms/description.h"

namespace hydro::model {

// What a parameter's size is measured by when a fit starts from it: quantities of a model and of runs, so
// that nothing depends on the units.
enum class Scale {
  kOne,           // the number itself
  kTorque,        // T_pmax
  kSpeed,         // the largest motor speed in the runs
  kPressure,      // the largest pressure in the runs
  kCharge,        // p_3
  kSample,        // the median time between samples
  kRate,          // one over kSample
  kFlow,          // D kSpeed over kPressure: a conductance that passes all of the pump's flow
  kArmStiffness,  // J_a over kSample^2: resonates with the arm at kRate, in rad/s
  kArmDamping,    // J_a over kSample
};

struct ParameterInfo {
  std::string name;
  std::string unit;         // in the paper's units
  double min = 0;           // smallest physical value
  double max = 0;           // largest physical value, infinity where there is none
  bool min_allowed = true;  // false: must be above min
  std::string says;         // one line
  bool is_name = false;     // the value is a name, one of `names`
  std::vector<std::string> names = {};
  // Where a fit of the effect starts, in `scale`s: each of them with each of the effect's other parameters'.
  // A parameter in which the effect is linear at 0 needs 0 only.
  std::vector<double> starts = {0};
  Scale scale = Scale::kOne;
};

// A base parameter and where it lies.
struct BaseParameter {
  ParameterInfo info;
  double Parameters::*member;
};

// The member of ParametersOf<T> that BaseParameters() has at `index`.
template <class T>
T& BaseValue(ParametersOf<T>& parameters, size_t index) {
  using P = ParametersOf<T>;
  constexpr T P::*kMembers[] = {&P::k_1,  &P::T_pmax, &P::D,   &P::J,   &P::b,   &P::T_s, &P::f,   &P::beta,
                                &P::V_ms, &P::c,      &P::c_E, &P::c_I, &P::p_3, &P::k_2, &P::J_a, &P::mgl};
  return parameters.*kMembers[index];
}

// All base parameters, in the order of Parameters.
const std::vector<BaseParameter>& BaseParameters();

// Where in BaseParameters() the one of this name is. Throws ModelError when there is none.
size_t BasePlace(const std::string& name);

// What the catalogue says of an effect. docs/effects.md has the same rows.
struct EffectInfo {
  std::string id;    // "pump.stribeck"
  std::string says;  // "static friction above kinetic"
  std::string equation;
  std::string confused_with;
  std::vector<ParameterInfo> parameters;  // all required
};

// The effects that this program knows, ordered by id.
const std::vector<EffectInfo>& EffectCatalogue();

// Null when no such effect is known.
const EffectInfo* FindEffect(const std::string& id);

}  // namespace hydro::model
