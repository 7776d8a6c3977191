// Every effect of the catalogue as the scan tries it: at grid points of its shape, with the numbers in which
// it is linear left open. Everything here follows from what the catalogue says about the parameters: this
// code knows no effect by name.
#pragma once

#include <string>
#include <vector>

#include "diagnose/fit/hypothesis.h"

namespace hydro::diagnose {

// Neighbours on a grid of one shape differ by no more than this factor, so that one of them approximates a
// term between them to a few per cent, and no estimate moves an effect further from its grid point.
inline constexpr double kGridRatio = 2;

struct EffectVariant {
  enum class Kind {
    kAmounts,  // linear in `amounts` from 0 on
    kWhole,    // as it stands at the grid point, scaled up or down as a whole
    kWave,     // repeats with the shaft: one amplitude and phase for each run, at one of many periods
  };
  std::string set;  // "pump.stribeck|0.03", "sensor.skew(p1)": the name of the change in sets of changes
  Change change;    // the effect and the channel it takes
  model::EffectDescription at;  // at its grid point, amounts at 0
  Kind kind = Kind::kAmounts;
  std::vector<std::string> amounts;  // kAmounts: linear from 0 on
  // kAmounts: a sine's phase, or "". The sine's size has the amount of the sine, the phase that of the
  // cosine.
  std::string phase;
  // kWhole: parameters without a grid of their own. The derivatives by their logarithms stand beside the
  // whole.
  std::vector<std::string> moved;
  // The amounts are times: sensors read late, and the error is linear in the time.
  bool is_time = false;
  // Parameters that this variant has on a grid.
  std::vector<std::string> shapes;
};

// The variants of those `changes` that are effects. `sizes` scales the grids.
std::vector<EffectVariant> VariantsOf(const std::vector<Change>& changes, const Sizes& sizes);

// Whether the effect vanishes where this number is 0 and grows in proportion to it: a size, or the amplitude
// of a wave.
bool IsAmount(const model::ParameterInfo& parameter);

}  // namespace hydro::diagnose
