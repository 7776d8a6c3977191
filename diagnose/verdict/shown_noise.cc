#include "diagnose/verdict/shown_noise.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "base/number_text.h"
#include "diagnose/data/noise_remarks.h"
#include "diagnose/fit/comparison.h"
#include "diagnose/fit/residuals.h"
#include "model/terms/model_error.h"

namespace hydro::diagnose {

std::optional<double> GapInShownNoise(const std::vector<const RunData*>& runs, const HeldOut& predicted) {
  const bool noisier = std::any_of(runs.begin(), runs.end(), [](const RunData* run) {
    return std::any_of(run->signals.begin(), run->signals.end(), IsNoisierThanStated);
  });
  if (!noisier) return std::nullopt;
  double sum = 0, count = 0;
  for (size_t r = 0; r < runs.size(); ++r) {
    Residuals residuals;
    try {
      residuals = ResidualsOf(predicted.models[r], *runs[r], predicted.starts[r]);
    } catch (const model::ModelError&) {
      return std::nullopt;
    }
    for (size_t s = 0; s + 1 < residuals.first.size(); ++s) {
      const SignalData& signal = runs[r]->signals[s];
      const double shown = IsNoisierThanStated(signal) ? signal.estimated_noise / signal.noise : 1;
      for (size_t i = residuals.first[s]; i < residuals.first[s + 1]; ++i) {
        sum += std::pow(residuals.values[i] / shown, 2);
        count += 1;
      }
    }
  }
  return count > 0 ? std::optional(std::sqrt(sum / count)) : std::nullopt;
}

std::string ShownNoiseSentence(Verdict verdict, std::optional<double> gap) {
  if (!IsOpen(verdict) || !gap) return "";
  const std::string left =
      " In units of the noise that the recordings themselves show, more than is stated, " +
      ShortNumber(*gap, 3) + " is left";
  if (!Closed(*gap * *gap, *gap * *gap, false)) return left + ".";
  return left + ", which is nothing but noise: mend the stated noise first (remarks).";
}

}  // namespace hydro::diagnose
