// Reads logs as runs for export.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "runs/exports/selection.h"
#include "runs/exports/sheet.h"
#include "runs/recorded/run_log.h"

namespace hydro::exports {

// Reads the logs in the order given. A log continues the run of the log before it when its states, from the
// same sender, follow the last states there (the recorder's rotation). Any other log is a run of its own,
// named by its file's stem. Each joint of a limb is also a run of its own, where `choice` leaves open which
// joint is meant; the joint's name follows that of the file. With `times`, the table's rows also say when
// they were received, which requires reading the log again. `say` receives each line for people about what is
// missing or odd. Throws InputError or log::LogError for a selection that a log lacks, a damaged log, a table
// that cannot be made, and a window that is empty.
std::vector<ExportedRun> ReadRuns(const std::vector<std::string>& files, const runs::StackChoice& choice,
                                  const Selection& selection, bool times,
                                  const std::function<void(const std::string&)>& say);

}  // namespace hydro::exports
