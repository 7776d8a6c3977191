// The sections of report.html that answer: what was found, how sure that is, what else may explain the runs, how much of the gap it
// takes, what remains and where, and what to measure next. Each is HTML, or "" where there is nothing to say.
#pragma once

#include <string>

#include "diagnose/data/diagnosis.h"

namespace hydro::diagnose {

// `diagnosis` is in the units that are shown; `si` for those of signals, which it has in the model's.
std::string WhatWasFound(const Diagnosis& diagnosis, bool si);
std::string HowSure(const Diagnosis& diagnosis);
// The explanations with their weights, the first `set_90` of them marked.
std::string WhatMayExplain(const Diagnosis& diagnosis);
std::string HowMuchOfTheGap(const Diagnosis& diagnosis);
std::string WhatRemains(const Diagnosis& diagnosis);
std::string WhatToMeasureNext(const Diagnosis& diagnosis);

}  // namespace hydro::diagnose
