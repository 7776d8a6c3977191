#include "base/tables/asked_layout.h"

#include <algorithm>
#include <string_view>
#include <vector>

#include "base/number_text.h"
#include "base/tables/clock_text.h"
#include "base/tables/csv_cells.h"
#include "base/tables/text_encoding.h"
#include "base/text_file.h"
#include "base/word_list.h"

namespace hydro::tables {
namespace {

constexpr size_t kMostHeaderLines = 10;  // below the names

// A line that has names of asked columns.
struct NamesLine {
  char separator = ',';
  size_t at = 0;               // index in Lines
  size_t names = 0;            // cells
  std::vector<size_t> places;  // places of the asked names among its cells
};

bool HoldsValue(std::string_view cell) {
  return ParseNumber(cell).has_value() || ParseDecimalComma(cell).has_value() || IsClock(cell);
}

// The cells of a line at the places of the asked columns.
std::vector<std::string_view> AskedCells(const Line& line, const NamesLine& names) {
  const std::vector<std::string_view> cells = CellsOf(line, names.separator);
  std::vector<std::string_view> asked;
  for (const size_t place : names.places) {
    if (place < cells.size()) asked.push_back(cells[place]);
  }
  return asked;
}

bool IsRow(const Line& line, const NamesLine& names) {
  const std::vector<std::string_view> cells = AskedCells(line, names);
  return std::any_of(cells.begin(), cells.end(), HoldsValue);
}

NamesLine NamesIn(const Lines& lines, size_t at, char separator, const AskedColumns& asked) {
  NamesLine names{separator, at, 0, {}};
  const std::vector<std::string_view> cells = CellsOf(lines[at], separator);
  names.names = cells.size();
  for (const std::string& name : asked.names) {
    const auto found = std::find_if(cells.begin(), cells.end(),
                                    [&](std::string_view cell) { return CellText(cell) == name; });
    if (found != cells.end()) names.places.push_back(static_cast<size_t>(found - cells.begin()));
  }
  return names;
}

// The next line below `from` that is not a comment.
size_t Below(const Lines& lines, size_t from) {
  size_t at = from + 1;
  while (at < lines.size() && lines[at].comment) ++at;
  return at;
}

// Whether the first line that looks like a row only numbers the columns or channels: 1, 2, 3. That is so when
// the times below it begin before its own number, or, if it stands below other lines that are no rows, also
// when they begin with that number.
bool NumbersColumns(const Lines& lines, size_t row, const NamesLine& names, size_t time_place,
                    bool below_others) {
  const std::vector<std::string_view> cells = CellsOf(lines[row], names.separator);
  if (cells.size() < 2) return false;
  for (size_t i = 0; i < cells.size(); ++i) {
    const std::optional<int64_t> number = ParseInteger(cells[i]), first = ParseInteger(cells[0]);
    if (!number || !first || *first < 0 || *first > 1 || *number != *first + static_cast<int64_t>(i))
      return false;
  }
  const size_t next = Below(lines, row);
  if (next >= lines.size()) return false;
  const std::vector<std::string_view> below = CellsOf(lines[next], names.separator);
  if (time_place >= below.size()) return false;
  std::optional<double> time = ParseNumber(below[time_place]);
  if (!time) time = ParseDecimalComma(below[time_place]);
  const auto own = static_cast<double>(*ParseInteger(cells[time_place]));
  return time && (*time < own || (below_others && *time == own));
}

// Counts the cells that have content, and those of them that are units.
struct UnitCount {
  size_t units = 0, texts = 0;
  bool all() const { return units > 0 && units == texts; }
};

UnitCount CountUnits(const std::vector<std::string_view>& cells) {
  UnitCount count;
  for (const std::string_view cell : cells) {
    if (cell.empty() || cell == "-") continue;
    ++count.texts;
    count.units += IsUnitCell(CellText(cell));
  }
  return count;
}

// The line of units among the lines between the names and the first row; 0: there is none.
size_t FindUnits(const Lines& lines, const std::vector<size_t>& between, const NamesLine& names,
                 const std::string& file, const CsvSettings& settings) {
  if (settings.units_row == false || between.empty()) return 0;
  if (settings.units_row == true) return lines[between.front()].number;
  bool perhaps = false;
  for (const size_t at : between) {
    if (IsRow(lines[at], names)) continue;  // the line numbers the columns: "1" is a unit too
    const UnitCount count = CountUnits(AskedCells(lines[at], names));
    if (count.all()) return lines[at].number;
    perhaps = perhaps || count.units > 0;
  }
  const Line& first = lines[between.front()];
  const std::string place = file + ": line " + std::to_string(first.number) + ": ";
  const std::string not_utf8 = NotUtf8(first.text);
  if (!perhaps && not_utf8.empty()) return 0;
  if (!not_utf8.empty()) throw InputError(place + not_utf8);
  throw InputError(place + "found " + Quoted(first.text) +
                   ", of which only some are units, allowed names or units: set units_row = true or "
                   "units_row = false in the sidecar");
}

CsvLayout LayoutBelow(const Lines& lines, const NamesLine& names, const std::string& file,
                      const CsvSettings& settings, const AskedColumns& asked) {
  CsvLayout layout;
  layout.separator = names.separator;
  layout.names_line = lines[names.at].number;
  layout.skip_lines = settings.skip_lines.value_or(0);
  const auto no_comment = [](const Line& line) { return !line.comment; };
  const bool first =
      std::none_of(lines.begin(), lines.begin() + static_cast<std::ptrdiff_t>(names.at), no_comment);
  if (!settings.skip_lines.has_value() && !first) layout.skip_lines = layout.names_line - 1;
  std::vector<size_t> between;
  size_t row = Below(lines, names.at);
  while (row < lines.size() && between.size() <= kMostHeaderLines && !IsRow(lines[row], names)) {
    between.push_back(row);
    row = Below(lines, row);
  }
  const std::vector<std::string_view> cells = CellsOf(lines[names.at], names.separator);
  const auto time = std::find_if(cells.begin(), cells.end(),
                                 [&](std::string_view cell) { return CellText(cell) == asked.time; });
  if (row < lines.size() && time != cells.end() &&
      NumbersColumns(lines, row, names, static_cast<size_t>(time - cells.begin()), !between.empty())) {
    between.push_back(row);
    row = Below(lines, row);
  }
  if (row >= lines.size() &&
      between.size() > 1) {  // no row at all, or none that can be read: the reader reports that
    row = between[settings.units_row == false ? 0 : 1];
    between.resize(settings.units_row == false ? 0 : 1);
  }
  layout.units_line = FindUnits(lines, between, names, file, settings);
  layout.units_row = layout.units_line > 0;
  layout.first_row = row < lines.size() ? lines[row].number : 0;
  for (const size_t at : between) {
    if (lines[at].number != layout.units_line) layout.passed_over.push_back(lines[at].number);
  }
  return layout;
}

// Whether most of the rows have as many cells as there are names.
bool Fits(const Lines& lines, const NamesLine& names) {
  // Blanks around another separator, "t , v", separate nothing.
  for (const std::string_view cell : CellsOf(lines[names.at], names.separator)) {
    if (cell == "," || cell == ";") return false;
  }
  constexpr size_t kJudged = 20;
  size_t judged = 0, good = 0;
  for (size_t at = Below(lines, names.at); at < lines.size() && judged < kJudged; at = Below(lines, at)) {
    if (!IsRow(lines[at], names)) continue;
    ++judged;
    good += CellsOf(lines[at], names.separator).size() == names.names;
  }
  return 2 * good >= judged;
}

}  // namespace

std::optional<CsvLayout> FindAskedLayout(const Lines& lines, const std::string& file,
                                         const CsvSettings& settings, const AskedColumns& asked) {
  std::vector<NamesLine> best;  // one for each separator that finds equally many
  for (const char separator : kSeparators) {
    if (settings.separator.value_or(separator) != separator) continue;
    // Blanks also split what tabs split.
    if (separator == ' ' && !best.empty() && best.back().separator == '\t') continue;
    NamesLine most;
    for (size_t at = 0; at < lines.size() && most.places.size() < asked.names.size(); ++at) {
      NamesLine names = NamesIn(lines, at, separator, asked);
      if (names.places.size() > most.places.size()) most = std::move(names);
    }
    if (most.places.empty()) continue;
    if (!best.empty() && most.places.size() > best.front().places.size()) best.clear();
    if (best.empty() || most.places.size() == best.front().places.size()) best.push_back(most);
  }
  if (best.empty()) return std::nullopt;
  if (best.size() > 1) std::erase_if(best, [&](const NamesLine& names) { return !Fits(lines, names); });
  // A table of one column reads the same by every separator.
  if (std::all_of(best.begin(), best.end(), [](const NamesLine& names) { return names.names == 1; }))
    best.resize(std::min<size_t>(best.size(), 1));
  if (best.size() > 1) {
    std::vector<std::string> names;
    names.reserve(best.size());
    for (const NamesLine& one : best) names.emplace_back(NameOf(one.separator));
    throw InputError(file + ": line " + std::to_string(lines[best.front().at].number) +
                     ": found cells that may be separated by " + Joined(names, " or by ") +
                     ", allowed one separator: set separator in the sidecar");
  }
  if (best.empty()) return std::nullopt;
  return LayoutBelow(lines, best.front(), file, settings, asked);
}

}  // namespace hydro::tables
