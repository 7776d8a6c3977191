// The run's table, one row per plant tick, as a sheet.
#pragma once

#include <string>
#include <vector>

#include "runs/exports/sheet.h"
#include "runs/run_log.h"

namespace hydro::exports {

// Returns the result of runs::ExportRun() with the unit and meaning of each column, and throws what that
// throws. `received` and the like are empty: SetTimesOf() fills them.
Sheet TableSheet(const runs::RunLog& log);

// Sets when each row's state was sent and received, from the sheet of the states of the same log.
void SetTimesOf(const Sheet& states, Sheet* table);

}  // namespace hydro::exports
