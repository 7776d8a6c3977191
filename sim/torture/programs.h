// The programs of a stack, as simulated processes run them: the same applications as in their mains.
#pragma once

#include "settings/stack_config.h"
#include "sim/torture/machines/simulated_process.h"

namespace hydro::torture {

class World;

// What the process `number` of that role does with that configuration, which must outlive it.
SimulatedProcess::Body ProgramOf(Role role, const settings::StackConfig& config, World& world, int number);

// What hydro-launch does: the launcher's own logic (launch/logic) over simulated children.
SimulatedProcess::Body LaunchProgram(const settings::StackConfig& config, World& world, int number);

// What an operator runs: hydro-launch --rearm; hydro-launch --stop, which finds nobody on its own machine. `watched`: somebody
// starts again what has ended, so soon that a patient operator would go on for ever.
SimulatedProcess::Body RearmProgram(const settings::StackConfig& config);
SimulatedProcess::Body StopProgram(const settings::StackConfig& config, bool watched);
// hydro-set with one of several values, allowed ones and others, or an undo: `which`, 0 to 7.
SimulatedProcess::Body SetProgram(const settings::StackConfig& config, int which);
// A planner: each twenty ticks a plan of a sine, a third of a second ahead.
SimulatedProcess::Body PlannerProgram(const settings::StackConfig& config);
// Somebody with the stack's key, who answers each state with a motor command of that voltage, numbered from
// `first_sequence` on.
SimulatedProcess::Body InsiderProgram(const settings::StackConfig& config, double voltage, double seconds,
                                      int64_t first_sequence);

}  // namespace hydro::torture
