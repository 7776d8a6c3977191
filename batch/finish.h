// The end of a study: table, pictures and page.
#pragma once

#include <string>

#include "batch/report/study_table.h"

namespace hydro::batch {

// Makes table.csv, table.json, the pictures and index.html in a study's folder from the cases that are there.
// Missing cases are counted and appear in the table as missing. Throws WriteError, StoreError, InputError.
TableCounts FinishStudy(const std::string& folder, int jobs);

}  // namespace hydro::batch
