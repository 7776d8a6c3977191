#include "tables/csv_lines.h"

#include "base/number_text.h"
#include "tables/csv_cells.h"

namespace hydro::tables {
namespace {

bool IsNumber(std::string_view cell) {
  return ParseNumber(cell).has_value() || ParseDecimalComma(cell).has_value();
}

}  // namespace

Lines LinesOf(std::string_view text, char separator, size_t skip, size_t most) {
  Lines lines;
  for (size_t number = 1; !text.empty() && lines.size() < most; ++number) {
    const size_t end = text.find('\n');
    const std::string_view line = WithoutEnd(text.substr(0, end), separator);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (number > skip && !line.empty()) lines.push_back({line, number, line.front() == '#'});
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
