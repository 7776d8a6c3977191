// The layout of a CSV text: found from the text, or stated by the user.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/input_error.h"
#include "base/tables/clock_text.h"

namespace hydro::tables {

struct CsvLayout {
  char separator = ',';    // ',', ';', '\t', or ' ' for runs of blanks and tabs
  char decimal = '.';      // or ','
  size_t skip_lines = 0;   // before the line of names
  bool units_row = false;  // the line below the names holds units, or units_line
  // When the layout was found by the names of the asked columns: the lines of the file, from 1. 0: found by
  // the rules of CsvText.
  size_t names_line = 0;
  size_t units_line = 0;
  size_t first_row = 0;
  std::vector<size_t> passed_over = {};  // lines between the two that are neither names nor units

  bool operator==(const CsvLayout&) const = default;
};

// The stated parts of a layout; the rest is found from the text.
struct CsvSettings {
  std::optional<char> separator = {};
  std::optional<char> decimal = {};
  std::optional<size_t> skip_lines = {};
  std::optional<bool> units_row = {};
};

// The columns that are asked of a table; nothing else in it is judged.
struct AskedColumns {
  std::vector<std::string> names = {};  // empty: all of the table
  std::string time = {};                // the asked column that may hold dates and times of day
  std::string date = {};                // the column that holds the dates for `time`
  // What comes first in their dates (clock_text.h, ShortDate); kUnknown: found from the rows.
  DateOrder date_order = DateOrder::kUnknown;

  bool all() const { return names.empty(); }
  bool Has(const std::string& name) const {
    return std::find(names.begin(), names.end(), name) != names.end();
  }
};

// Finds the layout of a text in UTF-8. When columns are asked for, the line that has most of their names
// determines it. Otherwise numbers decide: a separator fits if it splits a line, and most of those that
// follow, into numbers, as many as the line above them has names. A row of units is one whose every cell is a
// unit, below a line of equally many names. When no separator fits, the layout is the plain one, whose reader
// names the first cell that is wrong. Throws InputError, which states what to set, when the text can be read
// in two ways: a comma that may mark decimals or thousands, decimal points and decimal commas in one text, or
// a row of which only some cells are units. Also throws it when rows of numbers have no names.
CsvLayout FindLayout(std::string_view text, const std::string& file, const CsvSettings& settings,
                     const AskedColumns& asked = {});

// "semicolons between cells, decimal commas, names in line 4, units in line 5"; empty for the plain layout.
std::string Described(const CsvLayout& layout);

}  // namespace hydro::tables
