// The page's section on values that belong to a run: friction of the day, payload, temperature.
#pragma once

#include <string>

#include "diagnose/data/diagnosis.h"

namespace hydro::diagnose {

// A table for each value, a row for each run; empty if no value differs.
std::string PerRunSection(const Diagnosis& diagnosis);

}  // namespace hydro::diagnose
