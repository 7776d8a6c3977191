#include "diagnose/fit/prior.h"

#include <cmath>

#include "diagnose/fit/hypothesis.h"

namespace hydro::diagnose {

Prior KnownBefore(const Hypothesis& hypothesis) {
  Prior prior;
  for (const FreeParameter& parameter : hypothesis.Free()) {
    prior.centre.push_back(parameter.ToFitted(parameter.value));
    prior.weight.push_back(0);
    const Knowledge* known = hypothesis.known.get();
    if (known == nullptr || parameter.unknown.kind != model::Unknown::Kind::kBase) continue;
    const size_t base = parameter.unknown.index;
    const double given = known->given.parameters.*model::BaseParameters()[base].member;
    if (given == 0 || (parameter.logarithmic && given < 0)) continue;
    const double relative = model::UncertaintyOf(known->given, base);
    const double deviation = parameter.logarithmic ? relative : relative * std::abs(given);
    prior.centre.back() = parameter.ToFitted(given);
    prior.weight.back() = known->weight / (deviation * deviation);
  }
  return prior;
}

}  // namespace hydro::diagnose
