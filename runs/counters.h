// Finds angles that roll over in the columns of a table because their numbers have few bits.
#pragma once

#include <string>
#include <vector>

#include "base/tables/table.h"
#include "runs/signal_columns.h"

namespace hydro::runs {

// Unwraps an angle where a counter of 8 to 32 bits, or of one revolution, rolls over, and notes this in the
// table's layout. `source.column` lies in the table, whose values this changes. `revolution` is one
// revolution in the signal's unit; 0: there is none.
void CountAngleOn(const SignalColumn& source, const std::string& signal, double revolution,
                  tables::Table* table);

}  // namespace hydro::runs
