// hydro-launch --stop.
#pragma once

#include "launch/logic/operator_request.h"
#include "settings/stack_config.h"

namespace hydro::launch {

// Asks the processes of this machine to stop over their local sockets, the one that drives the motor first. Then publishes
// HYDRO_STOP until every process that is heard has announced its end. Exit code 0; 1 when nobody is there or a process does not
// end. A bus that cannot work is no obstacle where processes are found on this machine.
OperatorResult StopStack(const settings::StackConfig& config, const Asker& asker = kHydroLaunch,
                         const OperatorTiming& timing = {});

}  // namespace hydro::launch
