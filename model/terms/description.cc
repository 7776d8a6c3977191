#include "model/terms/description.h"

#include <algorithm>
#include <cmath>

#include "base/random.h"
#include "model/terms/parameter_info.h"

namespace hydro::model {

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
