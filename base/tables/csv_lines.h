// The lines of a CSV text, for finding its layout.
#pragma once

#include <cstddef>
#include <string_view>
#include <vector>

namespace hydro::tables {

// What may stand between cells; ' ' is any run of blanks and tabs.
inline constexpr char kSeparators[] = {',', ';', '\t', ' '};

const char* NameOf(char separator);

struct Line {
  std::string_view text;
  size_t number = 0;  // from 1
  bool comment = false;
};

using Lines = std::vector<Line>;

// The lines that are not blank, as the separator has their ends, up to `most`, after those that are skipped.
Lines LinesOf(std::string_view text, char separator, size_t skip, size_t most);

std::vector<std::string_view> CellsOf(const Line& line, char separator);

// Whether the cells are numbers, with points or commas, and empty ones, at least one of them a number.
bool AllNumbers(const std::vector<std::string_view>& cells);

}  // namespace hydro::tables
