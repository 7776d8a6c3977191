// Factors without a unit, as all runs together show them.
#pragma once

#include <optional>
#include <vector>

#include "diagnose/fit/recording_check.h"
#include "diagnose/fit/run_check.h"

namespace hydro::diagnose {

// Where no known mistake explains anything: a factor of one signal, if it explains most of the runs that are not in order.
// Runs that agree about it are given one factor, others their own.
std::vector<RecordingFinding> UnknownFactorFindings(const std::vector<std::optional<RunCheck>>& checks,
                                                    int jobs);

}  // namespace hydro::diagnose
