// Runs schedules: one of them once, or many for the shortest that still fails.
#pragma once

#include <functional>
#include <string>

#include "sim/torture/schedule/schedule.h"
#include "sim/torture/world.h"

namespace hydro::torture {

// `config_file` is a stack of the user's own; empty: the shipped one. `tail` is told what happens; it may be
// null.
RunOutcome RunSchedule(const Schedule& schedule, const std::string& config_file, MessageTail* tail = nullptr);

// Finds the shortest schedule that still fails: leaves out injections, halves durations and shortens the run
// as long as `fails` returns true for the rest. It must return true for `schedule` itself. Calls `fails` at
// most `most_runs` times.
Schedule Shrink(const Schedule& schedule, const std::function<bool(const Schedule&)>& fails,
                int most_runs = 300);

}  // namespace hydro::torture
