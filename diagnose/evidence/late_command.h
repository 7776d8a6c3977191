// Whether the command stands in the wrong row of its table: a recorder that writes what was acting, or what
// is to act from the next row on, makes it late or early by one sample; one that buffers, by several.
#pragma once

#include <string>
#include <vector>

#include "model/terms/description.h"
#include "runs/measured/measured_run.h"

namespace hydro::diagnose {

struct LateCommand {
  double rows = 0;   // by which the command is late against the motor and the pressures; below 0: early
  double error = 0;  // of rows, one standard error
};

// What the balances of these runs together show. The estimate is centred on the command as recorded, after it
// has been moved by `moved` rows. Runs without a torque balance, or whose motor and pressures are themselves
// apart, say nothing; without any other run the error is infinite.
LateCommand FindLateCommand(const model::ModelDescription& given, const std::vector<runs::MeasuredRun>& runs,
                            int moved, int jobs);

struct CommandRemarks {
  std::vector<std::string> late;   // the recording contradicts itself: a torque cannot precede its command
  std::vector<std::string> early;  // it may also be the amplifier that is late
};

// For each recorder, a line where the balances show that the command is late by one to five rows (and up to
// 20 ms), or early by one: beyond its uncertainty nearer to a whole row than to none, and right once it is
// moved by that many. The line has what mends it in the sidecar. Logs of this stack and runs without a
// sidecar are left out: their commands act at the tick they belong to.
CommandRemarks RemarksOnCommands(const model::ModelDescription& given,
                                 const std::vector<runs::MeasuredRun>& runs, int jobs);

}  // namespace hydro::diagnose
