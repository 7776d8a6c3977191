#include "diagnose/say/common_factor.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/number_text.h"
#include "base/word_list.h"
#include "diagnose/fit/likeliest_scale.h"
#include "diagnose/fit/prior.h"
#include "model/terms/parameter_info.h"

namespace hydro::diagnose {

std::string RemarkOnCommonFactor(const ProofContext& context, const Proof& proof, const Diagnosis& d) {
  const std::vector<model::BaseParameter>& base = model::BaseParameters();
  const auto yardstick = std::ranges::find_if(
      base, [&](const model::BaseParameter& one) { return IsYardstick(one.member, context.runs); });
  if (yardstick == base.end()) return "";
  std::vector<const ChangedParameter*> torques;
  double logarithms = 0;
  for (const FreeParameter& free : proof.Found().Free()) {
    if (free.name == yardstick->info.name) return "";  // asked for
    const bool shown = std::ranges::find(d.not_shown, free.name) == d.not_shown.end();
    if (!shown || !FollowsTorques(proof.Found().model, free)) continue;
    const auto changed = std::ranges::find(d.parameters, free.name,
                                           [](const ChangedParameter& one) { return one.fitted.name; });
    // One that stays as given, or that an effect brings, has no factor.
    if (changed == d.parameters.end() || !(changed->model > 0) || !(changed->fitted.value > 0)) return "";
    torques.push_back(&*changed);
    logarithms += std::log(changed->fitted.value / changed->model);
  }
  if (torques.size() < 2) return "";
  const double factor = std::exp(logarithms / static_cast<double>(torques.size()));
  std::vector<std::string> names;
  for (const ChangedParameter* one : torques) {
    const double low = one->fitted.low / one->model, high = one->fitted.high / one->model;
    const bool same = low <= factor && factor <= high, changed = high < 1 || low > 1;
    if (!same || !changed) return "";
    names.push_back(one->fitted.name);
  }
  return Enumerated(names) + " are all " + ShortNumber(factor, 2) + " times what the model has. " +
         yardstick->info.name + ", by which they are measured, may be " + ShortNumber(1 / factor, 3) +
         " times as large instead: the runs cannot tell";
}

}  // namespace hydro::diagnose
