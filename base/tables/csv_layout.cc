#include "base/tables/csv_layout.h"

#include <vector>

#include "base/tables/asked_layout.h"
#include "base/tables/csv_cells.h"
#include "base/tables/decimal_sign.h"
#include "base/text_file.h"
#include "base/word_list.h"

namespace hydro::tables {
namespace {

constexpr size_t kLookedLines = 500;  // lines from the top
constexpr size_t kJudged = 20;        // number of lines of which most must be numbers that fit

// One way to read the top of a text: lines of numbers, with names above them.
struct Reading {
  char separator = ',';
  size_t columns = 0;
  size_t rows = 0;   // the first line of numbers
  size_t names = 0;  // the line of names
  bool units = false;
};

enum class RowOfUnits { kNo, kYes, kPerhaps };

RowOfUnits Judge(const std::vector<std::string_view>& cells) {
  size_t units = 0, texts = 0;
  for (const std::string_view cell : cells) {
    if (cell.empty() || cell == "-") continue;
    ++texts;
    units += IsUnitCell(cell);
  }
  if (units == 0) return RowOfUnits::kNo;
  return units == texts ? RowOfUnits::kYes : RowOfUnits::kPerhaps;
}

// Whether most of the lines from `row` on consist of `columns` numbers.
bool MostlyNumbers(const Lines& lines, size_t row, char separator, size_t columns) {
  size_t judged = 0, good = 0;
  for (size_t i = row; i < lines.size() && judged < kJudged; ++i) {
    if (lines[i].comment) continue;
    const std::vector<std::string_view> cells = CellsOf(lines[i], separator);
    good += cells.size() == columns && AllNumbers(cells);
    ++judged;
  }
  return 2 * good >= judged;
}

// The nearest line above that is not a comment; `row` itself if there is none.
size_t Above(const Lines& lines, size_t row) {
  for (size_t i = row; i-- > 0;) {
    if (!lines[i].comment) return i;
  }
  return row;
}

// Finds the names above the first line of numbers; returns false when there are none.
bool FindNames(const Lines& lines, const std::string& file, const CsvSettings& settings, Reading* reading) {
  const auto fits = [&](size_t line) {
    const std::vector<std::string_view> cells = CellsOf(lines[line], reading->separator);
    return cells.size() == reading->columns && !AllNumbers(cells);
  };
  const size_t nearest = Above(lines, reading->rows);
  if (nearest == reading->rows) {
    // There are only comments above: the last of them may hold the names.
    if (reading->rows == 0 || !fits(reading->rows - 1)) return false;
    reading->names = reading->rows - 1;
    return true;
  }
  if (!fits(nearest)) return false;
  reading->names = nearest;
  const size_t next = Above(lines, nearest);
  if (next == nearest || !fits(next) || settings.units_row == false) return true;
  const RowOfUnits judged =
      settings.units_row == true ? RowOfUnits::kYes : Judge(CellsOf(lines[nearest], reading->separator));
  if (judged == RowOfUnits::kPerhaps) {
    throw InputError(file + ": line " + std::to_string(lines[nearest].number) + ": found " +
                     Quoted(lines[nearest].text) +
                     ", of which only some are units, allowed names or units: set units_row = true or "
                     "units_row = false in the sidecar");
  }
  if (judged == RowOfUnits::kNo) return true;
  reading->names = next;
  reading->units = true;
  return true;
}

// The first lines that the separator splits into numbers with names above; empty when there are none.
// `nameless` becomes the first line of numbers without names.
std::optional<Reading> Read(const Lines& lines, const std::string& file, char separator,
                            const CsvSettings& settings, const Line** nameless) {
  for (size_t i = 0; i < lines.size(); ++i) {
    if (lines[i].comment) continue;
    const std::vector<std::string_view> cells = CellsOf(lines[i], separator);
    if (cells.size() < 2 && separator != ',') continue;
    if (!AllNumbers(cells) || !MostlyNumbers(lines, i, separator, cells.size())) continue;
    Reading reading{separator, cells.size(), i, 0, false};
    if (FindNames(lines, file, settings, &reading)) return reading;
    if (cells.size() > 1 && *nameless == nullptr) *nameless = &lines[i];
  }
  return std::nullopt;
}

// The separator in the first line, for messages when the numbers do not determine it.
char SeparatorOfFirst(const Lines& lines) {
  for (const Line& line : lines) {
    if (line.comment) continue;
    for (const char separator : {',', ';', '\t'}) {
      if (line.text.find(separator) != std::string_view::npos) return separator;
    }
    break;
  }
  return ',';
}

// The only way to read the text; empty when none fits.
std::optional<Reading> FindReading(const Lines& lines, const std::string& file, const CsvSettings& settings,
                                   const AskedColumns& asked) {
  std::vector<Reading> readings;
  const Line* nameless = nullptr;
  for (const char separator : kSeparators) {
    if (settings.separator.value_or(separator) != separator) continue;
    // Blanks also split what tabs split.
    if (separator == ' ' && !readings.empty() && readings.back().separator == '\t') continue;
    const std::optional<Reading> reading = Read(lines, file, separator, settings, &nameless);
    if (!reading.has_value()) continue;
    if (separator == ',' && reading->columns == 1) {
      if (settings.separator.has_value()) return reading;
      continue;  // every text can be read as one column
    }
    readings.push_back(*reading);
  }
  if (readings.size() == 1) return readings.front();
  if (readings.size() > 1) {
    std::vector<std::string> names;
    names.reserve(readings.size());
    for (const Reading& reading : readings) names.emplace_back(NameOf(reading.separator));
    throw InputError(file + ": line " + std::to_string(lines[readings.front().rows].number) +
                     ": found cells that may be separated by " + Joined(names, " or by ") +
                     ", allowed one separator: set separator in the sidecar");
  }
  // When no names are asked for, numbers with commas between them may be names, for example of years or
  // channels.
  if (nameless != nullptr && !(asked.all() && AllNumbers(CellsOf(*nameless, ',')))) {
    throw InputError(
        file + ": line " + std::to_string(nameless->number) +
        ": found numbers without as many names in the line above, allowed a line of column names; "
        "where it stands elsewhere, set separator and skip_lines in the sidecar, and put quotes "
        "around names with blanks");
  }
  return std::nullopt;
}

}  // namespace

CsvLayout FindLayout(std::string_view text, const std::string& file, const CsvSettings& settings,
                     const AskedColumns& asked) {
  text = WithoutByteOrderMark(text);
  const size_t skipped = settings.skip_lines.value_or(0);
  // Tabs at the ends of lines matter only when tabs separate cells; for other separators these lines serve as
  // well.
  const Lines lines = LinesOf(text, '\t', skipped, kLookedLines);
  if (!asked.all()) {
    std::optional<CsvLayout> found = FindAskedLayout(lines, file, settings, asked);
    if (found.has_value()) {
      found->decimal = settings.decimal.value_or('.');
      if (!settings.decimal.has_value() && found->first_row > 0)
        found->decimal = FindDecimal(text, file, *found, found->first_row, asked);
      return *found;
    }
  }
  CsvLayout layout;
  layout.separator = settings.separator.value_or(',');
  layout.decimal = settings.decimal.value_or('.');
  layout.skip_lines = skipped;
  layout.units_row = settings.units_row.value_or(false);
  const std::optional<Reading> reading = FindReading(lines, file, settings, asked);
  if (!reading.has_value()) {
    layout.separator = settings.separator.value_or(SeparatorOfFirst(lines));
    return layout;
  }
  layout.separator = reading->separator;
  layout.units_row = reading->units;
  if (!settings.skip_lines.has_value()) {
    // Only lines that the plain reader would take for the names must be skipped.
    const size_t first =
        Above(lines, reading->names) == reading->names ? 0 : lines[reading->names].number - 1;
    layout.skip_lines = first;
  }
  if (!settings.decimal.has_value()) {
    layout.decimal = FindDecimal(text, file, layout, lines[reading->rows].number);
  }
  return layout;
}

std::string Described(const CsvLayout& layout) {
  std::vector<std::string> parts;
  if (layout.separator != ',') parts.push_back(std::string(NameOf(layout.separator)) + " between cells");
  if (layout.decimal != '.') parts.emplace_back("decimal commas");
  if (layout.skip_lines > 0) parts.push_back("names after line " + std::to_string(layout.skip_lines));
  if (layout.units_row) parts.emplace_back("a row of units");
  for (const size_t line : layout.passed_over)
    parts.push_back("line " + std::to_string(line) + " passed over, which is neither units nor numbers");
  return Joined(parts);
}

}  // namespace hydro::tables
