// A run as pictures: what the arm did, and what the pressures did.
#pragma once

#include "page/plot.h"
#include "tables/table.h"

namespace hydro::plot {

// `run` has the columns of hydro-log export (runs/run_table.h). Both throw an InputError that names the file and the
// column that is missing.

// The arm's angle with its reference, and the motor's speed.
page::Figure ArmFigure(const tables::Table& run);

// The pressure difference with its reference, both pressures, and the amplifier's voltage.
page::Figure PressureFigure(const tables::Table& run);

}  // namespace hydro::plot
