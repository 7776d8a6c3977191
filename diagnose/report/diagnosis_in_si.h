// A diagnosis in SI units, for --si.
#pragma once

#include "diagnose/data/diagnosis.h"

namespace hydro::diagnose {

// A signal and the unit it is shown in.
struct ShownUnit {
  std::string unit;
  double factor = 1;  // shown = factor * model's
};

// The unit of a channel: the model's, or SI (kPa).
ShownUnit UnitOf(model::Channel channel, const UnitSystem& units, bool si);

// Converts parameters, effects and missing terms from the model's units. Signals and curves stay as they are
// (see UnitOf), and so do the sentences.
Diagnosis InSi(Diagnosis diagnosis);

}  // namespace hydro::diagnose
