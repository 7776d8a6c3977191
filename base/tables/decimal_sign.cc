#include "base/tables/decimal_sign.h"

#include <algorithm>
#include <vector>

#include "base/tables/csv_cells.h"

namespace hydro::tables {
namespace {

bool IsDigits(std::string_view text) {
  return !text.empty() && text.find_first_not_of("0123456789") == std::string_view::npos;
}

// In "1,234" and "12,345,678", the commas may mark thousands.
bool MayBeThousands(std::string_view cell) {
  if (!cell.empty() && (cell.front() == '-' || cell.front() == '+')) cell.remove_prefix(1);
  size_t comma = cell.find(',');
  if (comma > 3 || !IsDigits(cell.substr(0, comma)) || cell.front() == '0') return false;
  while (comma != std::string_view::npos) {
    cell.remove_prefix(comma + 1);
    comma = cell.find(',');
    if (cell.substr(0, comma).size() != 3 || !IsDigits(cell.substr(0, comma))) return false;
  }
  return true;
}

// Which cells of a row are asked for; empty: all of them.
std::vector<bool> AskedPlaces(std::string_view text, const CsvLayout& layout, const AskedColumns& asked) {
  if (asked.all() || layout.names_line == 0) return {};
  const Lines lines = LinesOf(text, layout.separator, layout.names_line - 1, 1);
  std::vector<bool> places;
  for (const std::string_view cell :
       lines.empty() ? std::vector<std::string_view>{} : CellsOf(lines[0], layout.separator))
    places.push_back(asked.Has(CellText(cell)));
  return places;
}

}  // namespace

char FindDecimal(std::string_view text, const std::string& file, const CsvLayout& layout, size_t first,
                 const AskedColumns& asked) {
  const char separator = layout.separator;
  // When commas separate cells, only quoted cells can hold a decimal comma.
  if (separator == ',' && text.find('"') == std::string_view::npos) return '.';
  size_t with_point = 0, with_comma = 0;  // the first lines in which they occur
  bool thousands = true;
  const std::vector<bool> judged = AskedPlaces(text, layout, asked);
  std::vector<std::string_view> cells;
  for (const Line& line : LinesOf(text, separator, first - 1, std::string_view::npos)) {
    if (line.comment || line.text.find_first_of(".,") == std::string_view::npos) continue;
    SplitCells(line.text, separator, cells);
    for (size_t i = 0; i < cells.size(); ++i) {
      const std::string_view cell = cells[i];
      // The sign in a time of day does not count: 10:30:25,005.
      if ((!judged.empty() && (i >= judged.size() || !judged[i])) || cell.find(':') != std::string_view::npos)
        continue;
      if (cell.find(',') != std::string_view::npos) {
        if (with_comma == 0) with_comma = line.number;
        thousands = thousands && MayBeThousands(cell);
      } else if (with_point == 0 && cell.find('.') != std::string_view::npos) {
        with_point = line.number;
      }
    }
  }
  if (with_comma == 0) return '.';
  const std::string place = file + ": line " + std::to_string(with_comma) + ": found ";
  if (with_point != 0) {
    throw InputError(place + "a comma in a number, and in line " + std::to_string(with_point) +
                     " a decimal point, allowed one sign of decimals: set decimal = \",\" or decimal = \".\" "
                     "in the sidecar, and write numbers without separators of thousands");
  }
  if (thousands) {
    throw InputError(place +
                     "commas that may mark decimals or thousands, allowed a sign of decimals that is "
                     "certain: set decimal = \",\" in the sidecar, or take the separators of thousands "
                     "out");
  }
  return ',';
}

}  // namespace hydro::tables
