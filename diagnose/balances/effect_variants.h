// Every effect of the catalogue as the scan tries it: at grid points of its shape, with the numbers in which it is linear
// left open. All of it follows from what the catalogue says of the parameters: no effect is known here by name.
#pragma once

#include <string>
#include <vector>

#include "diagnose/fit/hypothesis.h"

namespace hydro::diagnose {

struct EffectVariant {
  enum class Kind {
    kAmounts,  // linear in `amounts` from 0 on
    kWhole,    // as it stands at the grid point, less or more of it as a whole
    kWave,     // repeats with the shaft: amplitude and phase of each run, at one of many periods
  };
  std::string set;  // "pump.stribeck|0.03", "sensor.skew(p1)": the name of the change in sets of changes
  Change change;    // the effect, with the channel it takes
  model::EffectDescription at;  // at its grid point, amounts at 0
  Kind kind = Kind::kAmounts;
  std::vector<std::string> amounts;  // kAmounts: linear from 0 on
  // kWhole: parameters that have no grid of their own; the derivatives by their logarithms come beside the whole.
  std::vector<std::string> moved;
  // Amounts that are times: of what sensors read late, linear in the time.
  bool is_time = false;
  // Parameters that are on a grid here.
  std::vector<std::string> shapes;
};

// Those of all `changes` that are effects. `sizes`: what grids are scaled with.
std::vector<EffectVariant> VariantsOf(const std::vector<Change>& changes, const Sizes& sizes);

// Whether the effect is gone where this number is 0, and grows with it in proportion: a size, or the amplitude of a wave.
bool IsAmount(const model::ParameterInfo& parameter);

// The parameters of an effect, by its entry in the catalogue.
const model::ParameterInfo& ParameterOf(const std::string& effect, const std::string& parameter);

}  // namespace hydro::diagnose
