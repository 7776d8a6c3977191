// The page of a study. It depends only on the study and its results, and not on the time of day or the host.
#pragma once

#include <string>

#include "batch/report/study_numbers.h"
#include "batch/report/study_table.h"

namespace hydro::batch {

// A self-contained HTML document.
std::string StudyPage(const Study& study, const TableCounts& counts, const StudyNumbers& numbers);

// Writes index.html and those of distributions.svg, worst.svg and surface.svg that exist into `folder`.
// Throws WriteError.
void WritePage(const Study& study, const std::string& folder, const TableCounts& counts,
               const StudyNumbers& numbers);

}  // namespace hydro::batch
