// The run's table, one row per plant tick, as a sheet.
#pragma once

#include <string>
#include <vector>

#include "runs/exports/sheet.h"
#include "runs/run_log.h"

namespace hydro::exports {

// What runs::ExportRun() makes of the log, and throws, with the unit and meaning of each column. `received` and the like are empty: SetTimesOf().
Sheet TableSheet(const runs::RunLog& log);

// When each row's state was sent and received, from the sheet of the states of the same log.
void SetTimesOf(const Sheet& states, Sheet* table);

}  // namespace hydro::exports
