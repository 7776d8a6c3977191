// Logs as runs for export.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "runs/exports/selection.h"
#include "runs/exports/sheet.h"
#include "runs/stack_choice.h"

namespace hydro::exports {

// Reads the logs in the order given. A log whose states go on where those of the log before end, from the same sender, is more of that
// run (the recorder's rotation); any other is a run of its own, named by its file's stem. So is each joint of a limb, where `choice` leaves
// open which is meant; its name stands behind that of the file. `times`: the table's rows too say when they were
// received, which takes another reading. `say` is called with each line for people about what is missing or odd.
// Throws InputError, log::LogError: what a log lacks of the selection, a log that is damaged, a table that cannot be made, a window in
// which nothing lies.
std::vector<ExportedRun> ReadRuns(const std::vector<std::string>& files, const runs::StackChoice& choice,
                                  const Selection& selection, bool times,
                                  const std::function<void(const std::string&)>& say);

}  // namespace hydro::exports
