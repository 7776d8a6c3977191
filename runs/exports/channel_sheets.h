// Reads the messages of chosen channels, and the run's table, into sheets.
#pragma once

#include <string>
#include <vector>

#include "runs/exports/sheet.h"
#include "runs/recorded/run_log.h"

namespace hydro::exports {

// Reads logs that continue one another. Makes a sheet for each of the channels (without suffix), with a row
// for each message, in the order of the log. Messages that cannot be decoded are left out, as in
// ReadRunLog(). Throws log::LogError where a log is damaged.
std::vector<Sheet> ReadChannels(const std::vector<std::string>& files, const std::string& suffix,
                                const std::vector<std::string>& channels);

// Returns the result of runs::ExportRun() with the unit and meaning of each column, and throws what that
// throws. `received` and the like are empty: SetTimesOf() fills them.
Sheet TableSheet(const runs::RunLog& log);

// Sets when each row's state was sent and received, from the sheet of the states of the same log.
void SetTimesOf(const Sheet& states, Sheet* table);

}  // namespace hydro::exports
