// A model's values in another system of units, for tests that nothing but the numbers changes with them.
#pragma once

#include <string>

#include "base/units.h"
#include "model/terms/parameter_info.h"

namespace hydro::testing {

// What a value in the first system is to be multiplied by to be in the second.
inline double Factor(const std::string& paper_unit, int arm, const UnitSystem& from, const UnitSystem& to) {
  return ParseUnit(from.UnitFor(paper_unit, arm))->size / ParseUnit(to.UnitFor(paper_unit, arm))->size;
}

// Both systems have a rotary arm, or both a linear one.
inline model::ModelDescription InUnits(model::ModelDescription model, const UnitSystem& to) {
  for (const model::BaseParameter& parameter : model::BaseParameters()) {
    model.parameters.*parameter.member *= Factor(parameter.info.unit, parameter.info.arm, model.units, to);
  }
  for (model::EffectDescription& effect : model.effects) {
    for (const model::ParameterInfo& info : model::FindEffect(effect)->parameters) {
      const auto value = effect.parameters.find(info.name);
      if (value != effect.parameters.end()) value->second *= Factor(info.unit, info.arm, model.units, to);
    }
  }
  model.units = to;
  return model;
}

// Systems with the same rig in them: pressures in psi, Pa, MPa and bar.
inline constexpr UnitSystem kSystems[] = {{"in", "lbf"}, {"m", "N"}, {"mm", "N"}, {"cm", "daN"}};

inline UnitSystem WithArm(UnitSystem units, bool linear) {
  units.linear_arm = linear;
  return units;
}

}  // namespace hydro::testing
