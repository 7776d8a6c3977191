// Finds the shortest schedule that still fails.
#pragma once

#include <functional>

#include "sim/torture/schedule/schedule.h"

namespace hydro::torture {

// Leaves out injections, halves durations and shortens the run as long as `fails` returns true for the rest.
// It must return true for `schedule` itself. Calls `fails` at most `most_runs` times.
Schedule Shrink(const Schedule& schedule, const std::function<bool(const Schedule&)>& fails,
                int most_runs = 300);

}  // namespace hydro::torture
