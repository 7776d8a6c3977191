// Implements hydro-launch --stop.
#pragma once

#include "launch/logic/operator_request.h"
#include "settings/stack_config.h"

namespace hydro::launch {

// Asks the processes of this machine to stop over their local sockets, the one that drives the motor first.
// Then publishes HYDRO_STOP until every process that is heard has announced its end. The exit code is 0, or 1
// when no process is found or one does not end. When processes are found on this machine, a bus that cannot
// work is no obstacle.
OperatorResult StopStack(const settings::StackConfig& config, const Asker& asker = kHydroLaunch,
                         const OperatorTiming& timing = {});

}  // namespace hydro::launch
