#include "base/tables/csv_lines.h"

#include <algorithm>

#include "base/number_text.h"
#include "base/tables/csv_cells.h"

namespace hydro::tables {
namespace {

bool IsNumber(std::string_view cell) {
  return ParseNumber(cell).has_value() || ParseDecimalComma(cell).has_value();
}

}  // namespace

const char* NameOf(char separator) {
  switch (separator) {
    case ';':
      return "semicolons";
    case '\t':
      return "tabs";
    case ' ':
      return "blanks";
    default:
      return "commas";
  }
}

Lines LinesOf(std::string_view text, char separator, size_t skip, size_t most) {
  Lines lines;
  for (size_t number = 1; !text.empty() && lines.size() < most; ++number) {
    // The skipped lines may hold any text, with any quotes.
    const size_t end = number <= skip ? text.find('\n') : EndOfLine(text);
    const std::string_view whole = text.substr(0, end);
    const std::string_view line = WithoutEnd(whole, separator);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (number > skip && !line.empty()) lines.push_back({line, number, line.front() == '#'});
    number += static_cast<size_t>(std::count(whole.begin(), whole.end(), '\n'));
  }
  return lines;
}

std::vector<std::string_view> CellsOf(const Line& line, char separator) {
  std::vector<std::string_view> cells;
  SplitCells(line.text, separator, cells);
  return cells;
}

bool AllNumbers(const std::vector<std::string_view>& cells) {
  bool any = false;
  for (const std::string_view cell : cells) {
    if (cell.empty()) continue;
    if (!IsNumber(cell)) return false;
    any = true;
  }
  return any;
}

}  // namespace hydro::tables
