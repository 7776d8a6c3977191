// How a CSV text is laid out: found from the text, or stated.
#pragma once

#include <algorithm>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/input_error.h"

namespace hydro::tables {

struct CsvLayout {
  char separator = ',';    // ',', ';', '\t', or ' ' for runs of blanks and tabs
  char decimal = '.';      // or ','
  size_t skip_lines = 0;   // before the line of names
  bool units_row = false;  // the line below the names holds units, or units_line
  // Where they were found by the names that are asked for: lines of the file from 1; 0: by the rules of CsvText.
  size_t names_line = 0;
  size_t units_line = 0;
  size_t first_row = 0;
  std::vector<size_t> passed_over = {};  // lines between them that are neither

  bool operator==(const CsvLayout&) const = default;
};

// What is stated about a layout; the rest is found from the text.
struct CsvSettings {
  std::optional<char> separator = {};
  std::optional<char> decimal = {};
  std::optional<size_t> skip_lines = {};
  std::optional<bool> units_row = {};
};

// What is asked of a table: nothing else in it is judged.
struct AskedColumns {
  std::vector<std::string> names = {};  // empty: all of the table
  std::string time = {};                // the one that may hold dates and times of day
  std::string date = {};                // one that has the dates of that

  bool all() const { return names.empty(); }
  bool Has(const std::string& name) const {
    return std::find(names.begin(), names.end(), name) != names.end();
  }
};

// The layout of a text in UTF-8. Where columns are asked for, the line that has most of their names tells it. Else numbers
// decide: a separator fits if it splits a line, and most of those that
// follow, into numbers, as many as the line above them has names. A row of units is one whose every cell is a
// unit, below a line of as many names. Where no separator fits, the layout is the plain one, whose reader
// names the first cell that is wrong. Throws InputError, which says what to set, where the text can be read
// in two ways: a comma that may mark decimals or thousands, decimal points and decimal commas in one text, or
// a row of which only some cells are units; and where rows of numbers have no names.
CsvLayout FindLayout(std::string_view text, const std::string& file, const CsvSettings& settings,
                     const AskedColumns& asked = {});

// "semicolons between cells, decimal commas, names in line 4, units in line 5"; empty for the plain layout.
std::string Described(const CsvLayout& layout);

}  // namespace hydro::tables
