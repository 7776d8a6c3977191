// Numbers of few bits in the columns of a table: angles that roll over.
#pragma once

#include <string>
#include <vector>

#include "base/tables/table.h"
#include "runs/signal_columns.h"

namespace hydro::runs {

// Counts an angle on where a counter of 8 to 32 bits, or one of a revolution, rolls over; the table's layout says so. `source.column`
// is in the table, in which its values change. `revolution`: one of it in the signal's unit; 0: it has none.
void CountAngleOn(const SignalColumn& source, const std::string& signal, double revolution,
                  tables::Table* table);

}  // namespace hydro::runs
