// report.json: a diagnosis for programs.
#pragma once

#include <string>

#include "diagnose/data/diagnosis.h"

namespace hydro::diagnose {

// "named", "tied", ...: a verdict as reports write it.
const std::string& VerdictName(Verdict verdict);

// docs/gap_finder.md describes the keys. `next_config` names the file of the next experiment, "" when there
// is none. Non-finite values become null.
std::string ReportJson(const Diagnosis& diagnosis, const std::string& next_config, double elapsed_s);

}  // namespace hydro::diagnose
