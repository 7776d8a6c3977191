// The programs of a stack, as simulated processes run them: the same applications as in their mains.
#pragma once

#include "settings/stack_config.h"
#include "sim/torture/machines/simulated_process.h"

namespace hydro::torture {

class World;

// The body of the process `number` of that role with that configuration, which must outlive it.
SimulatedProcess::Body ProgramOf(Role role, const settings::StackConfig& config, World& world, int number);

// The body of hydro-launch: the launcher's own logic (launch/logic) with simulated children.
SimulatedProcess::Body LaunchProgram(const settings::StackConfig& config, World& world, int number);

// The operator's programs: hydro-launch --rearm and hydro-launch --stop, which finds no process on its own
// machine. With `watched`, ended processes are started again so soon that a patient operator would go on for
// ever.
SimulatedProcess::Body RearmProgram(const settings::StackConfig& config);
SimulatedProcess::Body StopProgram(const settings::StackConfig& config, bool watched);
// hydro-set with one of several values, allowed and refused ones, or an undo. `which` is from 0 to 7.
SimulatedProcess::Body SetProgram(const settings::StackConfig& config, int which);
// A planner that sends a plan of a sine every twenty ticks, a third of a second ahead.
SimulatedProcess::Body PlannerProgram(const settings::StackConfig& config);
// An intruder with the stack's key, who answers each state with a motor command of that voltage, numbered
// from `first_sequence` on.
SimulatedProcess::Body InsiderProgram(const settings::StackConfig& config, double voltage, double seconds,
                                      int64_t first_sequence);

}  // namespace hydro::torture
