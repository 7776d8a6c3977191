#include "base/tables/unit_cells.h"

#include <algorithm>
#include <iterator>

#include "base/tables/csv_cells.h"
#include "base/unit_system.h"
#include "base/units.h"

namespace hydro::tables {
namespace {

// Units of quantities that no signal measures, and of pressures that count from another zero.
constexpr std::string_view kOthers[] = {"A",      "mA",     "%",     "°C",    "degC",  "C",    "K",    "W",
                                        "kW",     "g",      "l/min", "L/min", "psig",  "psia", "barg", "bara",
                                        "bar(g)", "bar(a)", "1/min", "m/s²",  "m/s^2", "dB"};

std::string_view WithoutBrackets(std::string_view cell) {
  cell = Trimmed(cell);
  if (cell.size() < 2) return cell;
  const bool bracketed =
      (cell.front() == '[' && cell.back() == ']') || (cell.front() == '(' && cell.back() == ')');
  return bracketed ? Trimmed(cell.substr(1, cell.size() - 2)) : cell;
}

}  // namespace

std::string UnitOfCell(std::string_view cell) { return std::string(OurSpelling(WithoutBrackets(cell))); }

bool IsUnitCell(std::string_view cell) {
  if (WithoutBrackets(cell).size() != Trimmed(cell).size()) return true;
  const std::string unit = UnitOfCell(cell);
  return ParseUnit(unit).has_value() ||
         std::find(std::begin(kOthers), std::end(kOthers), unit) != std::end(kOthers);
}

}  // namespace hydro::tables
