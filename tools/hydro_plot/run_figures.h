// A run as pictures: the arm's motion and the pressures.
#pragma once

#include "base/tables/table.h"
#include "page/plot.h"

namespace hydro::plot {

// `run` has the columns of hydro-log export (runs/recorded/run_table.h). Both functions throw InputError
// naming the file and the missing column.

// The arm's angle and its reference, and the motor's speed.
page::Figure ArmFigure(const tables::Table& run);

// The pressure difference and its reference, both pressures, and the amplifier's voltage.
page::Figure PressureFigure(const tables::Table& run);

}  // namespace hydro::plot
