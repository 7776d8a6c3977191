#include "model/sides.h"

#include <string>

namespace hydro::model {
namespace {

double Parameter(const ModelDescription& model, const std::string& id, const char* name) {
  for (const EffectDescription& effect : model.effects) {
    if (effect.id != id) continue;
    const auto found = effect.parameters.find(name);
    if (found != effect.parameters.end()) return found->second;
  }
  return 0;
}

}  // namespace

Differences DifferencesOf(const ModelDescription& model) {
  return {.areas = Parameter(model, "actuator.unequal_areas", "difference"),
          .volumes = Parameter(model, "actuator.unequal_volumes", "difference"),
          .displacements = Parameter(model, "pump.unequal_displacements", "difference")};
}

Travel TravelOf(const ModelDescription& model) {
  const Parameters& p = model.parameters;
  const Differences differ = DifferencesOf(model);
  // Where the sides are equal, these are the bits of V_ms/c.
  return {.least = -(p.V_ms * (1 + differ.volumes)) / (p.c * (1 + differ.areas)),
          .most = p.V_ms * (1 - differ.volumes) / (p.c * (1 - differ.areas))};
}

}  // namespace hydro::model
