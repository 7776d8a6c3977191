// The units of exported values: those of the run's model, or SI.
#pragma once

#include <string>

#include "base/tables/table.h"
#include "base/unit_system.h"
#include "runs/exports/sheet.h"

namespace hydro::exports {

// The unit in which the paper states a column of the run's table, from its name: "psi" for "p1_psi"; empty:
// none.
std::string PaperUnit(const std::string& run_column);

// The unit of a message's field when it comes from a stack in these units; "" where it has no unit.
std::string UnitOfField(const UnitSystem& units, const definitions::Field& field);

// Sets the columns' units to those of their values, according to the units of the run's model; with `si`,
// converts the values. The names of the table's columns state the units.
void SetUnits(const UnitSystem& units, bool si, Sheet* sheet);

// The same for a table that runs::ExportRun() made.
void SetUnits(const UnitSystem& units, bool si, tables::Table* table);

}  // namespace hydro::exports
