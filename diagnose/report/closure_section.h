// Closures in report.html.
#pragma once

#include <string>

#include "diagnose/data/diagnosis.h"

namespace hydro::diagnose {

// Each closure's curve with its band, or some cuts through its surface, and the gap before and after; "" without any.
std::string ClosureSection(const Diagnosis& diagnosis);

}  // namespace hydro::diagnose
