// [columns] of a sidecar: which columns of a table are which signals, and in what units.
#pragma once

#include "base/input_error.h"
#include "base/tables/table.h"
#include "runs/measured/measured_run.h"
#include "settings/toml/section_reader.h"
#include "settings/toml/toml_document.h"

namespace hydro::runs {

// The columns that a sidecar names, rightly or wrongly. No other part of the table is checked.
tables::AskedColumns AskedBy(const settings::TomlNode& sidecar);

// Reads them into the run, with its times, lines and layout. May leave out rows of the table (table_times.h).
// Throws InputError.
void ReadColumns(settings::SectionReader columns, tables::Table* table, MeasuredRun* run);

}  // namespace hydro::runs
