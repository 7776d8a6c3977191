// The programs of a stack, as simulated processes run them: the same applications as in their mains.
#pragma once

#include "settings/stack_config.h"
#include "torture/machines/simulated_process.h"

namespace hydro::torture {

class World;

// What the process `number` of that role does with that configuration, which must outlive it.
SimulatedProcess::Body ProgramOf(Role role, const settings::StackConfig& config, World& world, int number);

// What an operator runs: asks the plant of that session to end its latched faults, as hydro-launch --rearm does; tells
// everybody to end, as hydro-launch --stop does over the bus.
SimulatedProcess::Body RearmProgram(const settings::StackConfig& config, int64_t plant);
// Somebody with the stack's key, who answers each state with a motor command of that voltage.
SimulatedProcess::Body InsiderProgram(const settings::StackConfig& config, double voltage, double seconds);
SimulatedProcess::Body StopProgram(const settings::StackConfig& config);

}  // namespace hydro::torture
