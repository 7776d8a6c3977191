// A made-up diagnosis, for tests of how a diagnosis is reported.
#pragma once

#include "diagnose/recording/diagnosis.h"

namespace hydro::testing {

// pump.stribeck named, fluid.warming tied with b drifting, J implausible; two runs of `samples` samples, the
// second held out.
diagnose::Diagnosis ExampleDiagnosis(size_t samples = 600);

// Nothing found, nothing to show.
diagnose::Diagnosis EmptyDiagnosis();

}  // namespace hydro::testing
