// The sections [effects."id"] of a model file, and what the file may say of a parameter. Only for the
// files of settings/.
#pragma once

#include <string>
#include <vector>

#include "base/unit_system.h"
#include "model/terms/description.h"
#include "model/terms/parameter_info.h"
#include "settings/toml/section_reader.h"

namespace hydro::settings {

// No machine has a number of a size beyond these, in any units. Where 0 is allowed, a number next to 0 is as
// good as 0. Where it is not, a number that is too close to 0 gives quotients that no machine has.
inline NumberRange RangeOf(const model::ParameterInfo& info) {
  constexpr double kLargest = 1e30;
  NumberRange range{.min = info.min,
                    .max = info.max,
                    .min_allowed = info.min_allowed,
                    .largest = kLargest,
                    .beyond_max = info.beyond_max};
  if (!range.Holds(0)) range.smallest = 1 / kLargest;
  return range;
}

inline std::string Wanted(const model::ParameterInfo& info, const UnitSystem& units) {
  return RangeOf(info).Allowed() + " (" + info.UnitIn(units) + ", " + info.meaning + ")";
}

// Reads the effects in the section `effects`, whose table is `table` (null: there is none). Throws InputError
// naming place and key.
std::vector<model::EffectDescription> ReadEffects(SectionReader section, const TomlNode* table,
                                                  const UnitSystem& units);

// The table that ReadEffects reads back bit by bit.
TomlNode EffectsNode(const std::vector<model::EffectDescription>& effects);

}  // namespace hydro::settings
