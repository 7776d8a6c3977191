// What a model file may say of a parameter. Only for the files of settings/.
#pragma once

#include <string>

#include "model/terms/parameter_info.h"
#include "settings/toml/section_reader.h"

namespace hydro::settings {

inline NumberRange RangeOf(const model::ParameterInfo& info) {
  return {.min = info.min, .max = info.max, .min_allowed = info.min_allowed};
}

inline std::string Wanted(const model::ParameterInfo& info, const UnitSystem& units) {
  return RangeOf(info).Allowed() + " (" + info.UnitIn(units) + ", " + info.meaning + ")";
}

}  // namespace hydro::settings
