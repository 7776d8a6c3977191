#include "model/terms/description.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "base/units.h"
#include "model/terms/parameter_info.h"

namespace hydro::model {

// The only number with a unit in the equations. It is 14.6959 psi in every system, so that the same rig moves
// in the same way whatever its units; 101325 Pa differs from this by 4 in a million.
double AtmosphereOf(const ModelDescription& model) {
  constexpr double kPsiOfAir = 14.6959;
  const bool named = model.units != UnitSystem{};
  // A model that does not state its units may still be in SI: no liquid has a beta of 1e7 psi.
  const double unit = named                         ? ParseUnit(model.units.UnitFor("psi"))->size
                      : model.parameters.beta > 1e7 ? 1
                                                    : kPsi;
  return unit == kPsi ? kPsiOfAir : kPsiOfAir * kPsi / unit;
}

void Deviate(ModelDescription* model, size_t base, double deviations) {
  constexpr double kMost = 13.8;  // about log(10^6)
  const double change = std::clamp(UncertaintyOf(*model, base) * deviations, -kMost, kMost);
  BaseValue(model->parameters, base) *= std::exp(change);
}

double DrawnDeviation(uint64_t seed, uint64_t index, std::string_view parameter) {
  return StandardNormal(Scatter(Scatter(Scatter(seed) ^ index) ^ NameKey(parameter)));
}

ModelDescription DrawnModel(const ModelDescription& known, uint64_t seed, uint64_t index) {
  ModelDescription drawn = known;
  for (size_t base = 0; base < BaseParameters().size(); ++base) {
    Deviate(&drawn, base, DrawnDeviation(seed, index, BaseParameters()[base].info.name));
  }
  return drawn;
}

}  // namespace hydro::model
