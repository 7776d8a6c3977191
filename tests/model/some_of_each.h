// Every effect of the catalogue at the example size of its entry, for tests that go through the catalogue.
#pragma once

#include <map>
#include <string>

#include "model/terms/parameter_info.h"
#include "tests/model/model_case.h"

namespace hydro::testing {

// All but amp.delay, which has a memory and a test of its own. The motor turns little within a period, so
// that differences see the slope.
inline const std::map<std::string, model::EffectDescription>& SomeOfEach() {
  static const std::map<std::string, model::EffectDescription> effects = [] {
    std::map<std::string, model::EffectDescription> by_id;
    for (const model::EffectInfo& info : model::EffectCatalogue()) {
      if (info.id == "amp.delay") continue;
      model::EffectDescription effect{info.id, {}, {}};
      for (const model::ParameterInfo& parameter : info.parameters) {
        if (parameter.is_name()) {
          effect.names[parameter.name] = parameter.names.back();
        } else {
          effect.parameters[parameter.name] =
              parameter.role == model::Role::kPeriods ? 0.2 : parameter.example;
        }
      }
      by_id[info.id] = effect;
    }
    return by_id;
  }();
  return effects;
}

}  // namespace hydro::testing
