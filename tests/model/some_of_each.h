// Every effect of the catalogue at the example size of its entry, for tests that go through the catalogue.
#pragma once

#include <map>
#include <memory>
#include <string>

#include "model/effects/catalogue.h"
#include "model/terms/parameter_info.h"
#include "tests/model/model_case.h"

namespace hydro::testing {

// The motor turns little within a period, so that differences see the slope.
inline model::EffectDescription ExampleOf(const model::EffectInfo& info) {
  model::EffectDescription effect{info.id, {}, {}};
  for (const model::ParameterInfo& parameter : info.parameters) {
    if (parameter.is_name()) {
      effect.names[parameter.name] = parameter.names.back();
    } else {
      effect.parameters[parameter.name] = parameter.role == model::Role::kPeriods ? 0.2 : parameter.example;
    }
  }
  return effect;
}

// Whether a command acts later than it is given. Such an effect's derivatives are those of its stops, and
// have tests of their own.
inline bool DelaysCommands(const model::EffectInfo& info) {
  const std::unique_ptr<model::Effect> effect = model::FindCatalogueEntry(info.id)->make(ExampleOf(info));
  effect->Command(0, 1);
  return effect->NextStop(0) < model::kUnbounded;
}

// All but those that delay commands.
inline const std::map<std::string, model::EffectDescription>& SomeOfEach() {
  static const std::map<std::string, model::EffectDescription> effects = [] {
    std::map<std::string, model::EffectDescription> by_id;
    for (const model::EffectInfo& info : model::EffectCatalogue()) {
      if (!DelaysCommands(info)) by_id[info.id] = ExampleOf(info);
    }
    return by_id;
  }();
  return effects;
}

}  // namespace hydro::testing
