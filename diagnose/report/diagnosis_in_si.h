// A diagnosis in SI units, for --si.
#pragma once

#include "diagnose/data/diagnosis.h"

namespace hydro::diagnose {

// A signal and the unit it is shown in.
struct ShownUnit {
  std::string unit;
  double factor = 1;  // shown = factor * model's
};

// The unit of a channel: the paper's, or SI (kPa).
ShownUnit UnitOf(model::Channel channel, bool si);

// Parameters, effects and missing terms converted from the paper's units. Signals and curves are unchanged (see UnitOf), and
// so are the sentences.
Diagnosis InSi(Diagnosis diagnosis);

}  // namespace hydro::diagnose
