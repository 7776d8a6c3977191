// Runs schedules on the stacks that hydro-torture knows: one of them once, or many for the shortest that
// still fails.
#pragma once

#include <functional>
#include <string>

#include "settings/stack_config.h"
#include "sim/torture/schedule/schedule.h"
#include "sim/torture/world.h"

namespace hydro::torture {

// The configuration of a schedule's stack: the shipped one, or `file` (empty: none), with the schedule's
// modes.
settings::StackConfig ConfigFor(const Schedule& schedule, const std::string& file);

// The same stack with other gains and limits, as run by a process that was restarted by mistake.
settings::StackConfig OtherConfig(const settings::StackConfig& config);

// The same stack as one joint of a limb, then as the other joint; and what such joints have in common, for an
// operator.
settings::StackConfig HipOf(settings::StackConfig config);
settings::StackConfig KneeOf(settings::StackConfig config);
settings::StackConfig LimbOf(settings::StackConfig config);

// The same configuration for a program of another version.
settings::StackConfig OtherVersion(settings::StackConfig config);

// `config_file` is a stack of the user's own; empty: the shipped one. `tail` is told what happens; it may be
// null.
RunOutcome RunSchedule(const Schedule& schedule, const std::string& config_file, MessageTail* tail = nullptr);

// Finds the shortest schedule that still fails: leaves out injections, halves durations and shortens the run
// as long as `fails` returns true for the rest. It must return true for `schedule` itself. Calls `fails` at
// most `most_runs` times.
Schedule Shrink(const Schedule& schedule, const std::function<bool(const Schedule&)>& fails,
                int most_runs = 300);

}  // namespace hydro::torture
