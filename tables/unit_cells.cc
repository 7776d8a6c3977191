#include "tables/unit_cells.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "base/units.h"
#include "tables/csv_cells.h"

namespace hydro::tables {
namespace {

// Spellings of one meaning only. Upper and lower case differ otherwise: mPa is not MPa.
constexpr std::pair<std::string_view, std::string_view> kSpellings[] = {
    {"sec", "s"},      {"Sec", "s"},        {"S", "s"},          {"msec", "ms"},     {"volt", "V"},
    {"Volt", "V"},     {"volts", "V"},      {"Volts", "V"},      {"PSI", "psi"},     {"Psi", "psi"},
    {"BAR", "bar"},    {"Bar", "bar"},      {"RPM", "rpm"},      {"Rpm", "rpm"},     {"r/min", "rpm"},
    {"U/min", "rpm"},  {"Nm", "N m"},       {"N*m", "N m"},      {"N·m", "N m"},     {"°", "deg"},
    {"degree", "deg"}, {"degrees", "deg"},  {"Deg", "deg"},      {"DEG", "deg"},     {"°/s", "deg/s"},
    {"µs", "us"},      {"\xce\xbcs", "us"}, {"radian", "rad"},   {"radians", "rad"}, {"RAD", "rad"},
    {"rev", "rev"},    {"µm", "um"},        {"\xce\xbcm", "um"}, {"inch", "in"},     {"KPa", "kPa"}};

// Units of what no signal measures, and of pressures that count from elsewhere.
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

std::string UnitOfCell(std::string_view cell) {
  const std::string_view unit = WithoutBrackets(cell);
  const auto* spelling = std::find_if(std::begin(kSpellings), std::end(kSpellings),
                                      [&](const auto& row) { return row.first == unit; });
  return std::string(spelling == std::end(kSpellings) ? unit : spelling->second);
}

bool IsUnitCell(std::string_view cell) {
  if (WithoutBrackets(cell).size() != Trimmed(cell).size()) return true;
  const std::string unit = UnitOfCell(cell);
  return ParseUnit(unit).has_value() ||
         std::find(std::begin(kOthers), std::end(kOthers), unit) != std::end(kOthers);
}

}  // namespace hydro::tables
