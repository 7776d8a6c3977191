// report.json: a diagnosis for programs.
#pragma once

#include <string>

#include "diagnose/data/diagnosis.h"

namespace hydro::diagnose {

// "named", "tied", ...: a verdict as reports write it.
const std::string& VerdictName(Verdict verdict);

// docs/gap_finder.md says what the keys are. `next_config` names the file of the next experiment, "" when
// there is none. What is not finite is null.
std::string ReportJson(const Diagnosis& diagnosis, const std::string& next_config, double elapsed_s);

}  // namespace hydro::diagnose
