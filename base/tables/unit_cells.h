// Recognises the cells of a row of units, as recorders write them.
#pragma once

#include <string>
#include <string_view>

namespace hydro::tables {

// The cell without its brackets, spelled as in base/units if the unit is known there: "[°/s]" is "deg/s",
// "PSI" is "psi", "U/min" is "rpm". Other texts come back unchanged.
std::string UnitOfCell(std::string_view cell);

// Whether the cell is a unit: one of base/units, another that recorders write (A, %, °C), or any text in
// brackets.
bool IsUnitCell(std::string_view cell);

}  // namespace hydro::tables
