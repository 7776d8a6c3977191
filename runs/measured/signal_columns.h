// Reads columns of a table as a run's signals: their units, and angles that roll over because their
// numbers have few bits.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/input_error.h"
#include "base/tables/table.h"
#include "runs/measured/measured_run.h"

namespace hydro::runs {

// A column of a table in our units: ours = unit * (scale * theirs + offset).
struct SignalColumn {
  const tables::Column* column = nullptr;
  double scale = 1;
  double offset = 0;
  double unit = 1;
  bool by_row = false;  // the unit comes from the table's row of units
  double delay = 0;     // s by which it is late

  // The scale and offset with the unit multiplied in.
  ColumnSource Described() const { return {column->name, unit * scale, unit * offset, delay}; }
};

bool AllMissing(const std::vector<double>& values);

// The values in our units. Throws InputError for an infinite one.
std::vector<double> SignalValues(const tables::Table& table, const SignalColumn& source);

// The times. Throws InputError for a time that is missing or not above the one before, and for a single row.
std::vector<double> SampleTimes(const tables::Table& table, const SignalColumn& source);

// The command, held where a value is missing. Throws InputError when the first row has no value. `what` is
// the command's key.
std::vector<double> CommandValues(const tables::Table& table, const SignalColumn& source,
                                  const std::string& what = "voltage");

// How many of `ours` make one of `theirs`: 1e5 for bar and Pa. Empty where `theirs` is not a unit or measures
// something else.
std::optional<double> UnitFactor(const std::string& theirs, const std::string& ours);

// The usual units for what `ours` measures, for messages. Any other text for such a unit is also accepted.
std::vector<std::string> UnitsLike(const std::string& ours);

// Unwraps an angle where a counter of 8 to 32 bits, or of one revolution, rolls over, and notes this in the
// table's layout. `source.column` lies in the table, whose values this changes. `revolution` is one
// revolution in the signal's unit; 0: there is none.
void CountAngleOn(const SignalColumn& source, const std::string& signal, double revolution,
                  tables::Table* table);

}  // namespace hydro::runs
