// Splits a CSV text into lines, for finding its layout.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace hydro::tables {

// The characters that may stand between cells; ' ' is any run of blanks and tabs.
inline constexpr char kSeparators[] = {',', ';', '\t', ' '};

const char* NameOf(char separator);

struct Line {
  std::string_view text;
  size_t number = 0;  // from 1
  bool comment = false;
};

using Lines = std::vector<Line>;

// The lines that are not blank, each without its end (WithoutEnd() of csv_cells.h): at most `most`, after
// those that are skipped.
Lines LinesOf(std::string_view text, char separator, size_t skip, size_t most);

std::vector<std::string_view> CellsOf(const Line& line, char separator);

// Whether every cell is empty or a number, with a point or a comma, and at least one is a number.
bool AllNumbers(const std::vector<std::string_view>& cells);

}  // namespace hydro::tables
