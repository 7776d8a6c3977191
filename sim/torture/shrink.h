// The shortest schedule that still fails.
#pragma once

#include <functional>

#include "sim/torture/schedule/schedule.h"

namespace hydro::torture {

// Leaves out injections, halves durations and shortens the run while `fails` returns true for the rest; it
// does for `schedule` itself. Calls it at most `most_runs` times.
Schedule Shrink(const Schedule& schedule, const std::function<bool(const Schedule&)>& fails,
                int most_runs = 300);

}  // namespace hydro::torture
