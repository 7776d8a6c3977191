// The units of exported values: those of the run's model, or SI.
#pragma once

#include <string>

#include "base/unit_system.h"
#include "exports/sheet.h"
#include "tables/table.h"

namespace hydro::exports {

// The unit in which the paper has a column of the run's table, from its name: "psi" for "p1_psi"; empty: none.
std::string PaperUnit(const std::string& run_column);

// Sets the columns' units to what their values are in, by the units of the run's model; with `si` converts them, and the names of the
// table's columns say so.
void SetUnits(const UnitSystem& units, bool si, Sheet* sheet);

// The same for a table that runs::ExportRun() made, in SI.
void ShowInSi(const UnitSystem& units, tables::Table* table);

// "rad_s" for "rad/s", for names.
std::string UnitInName(const std::string& unit);

}  // namespace hydro::exports
