// Numbers of few bits in the columns of a table: angles that roll over, and signed numbers read as unsigned.
#pragma once

#include <string>
#include <vector>

#include "runs/signal_columns.h"
#include "tables/table.h"

namespace hydro::runs {

// Counts an angle on where a counter of 8 to 32 bits, or one of a revolution, rolls over; the table's layout says so. `source.column`
// is in the table, in which its values change. `revolution`: one of it in the signal's unit; 0: it has none.
void CountAngleOn(const SignalColumn& source, const std::string& signal, double revolution,
                  tables::Table* table);

// What is said of a command that is never below 0 though the motor runs both ways with it, where its upper values would be its
// lower ones with 2^8 to 2^32 counts less: "voltage jumps by 65536 counts ...". Empty where nothing is wrong. `motion`: the motor's
// speed, in rows of the table.
std::string UnsignedCommand(const SignalColumn& command, const std::vector<double>& motion,
                            const tables::Table& table);

}  // namespace hydro::runs
