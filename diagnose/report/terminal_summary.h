// A diagnosis in about ten lines, for a terminal.
#pragma once

#include <string>

#include "diagnose/data/diagnosis.h"

namespace hydro::diagnose {

// `folder`: where the report is. With `si`, figures are in SI.
std::string TerminalSummary(const Diagnosis& diagnosis, const std::string& folder, bool si);

// "b 0.0203 [0.0199, 0.0207] in-lbf-s"
std::string WithInterval(const Estimated& estimated);

}  // namespace hydro::diagnose
