#include "settings/csv_points.h"

#include <algorithm>
#include <cmath>

#include "base/number_text.h"
#include "base/tables/csv_text.h"
#include "base/text_file.h"
#include "base/word_list.h"

namespace hydro::settings {
using tables::CsvLayout;
using tables::CsvText;
using tables::FindLayout;
using tables::Trimmed;
namespace {

size_t ColumnOf(const CsvText& text, const std::string& name) {
  std::vector<std::string> names;
  for (const std::string& column : text.names()) names.emplace_back(Trimmed(column));
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    throw InputError(text.Place() + ": found no column " + Quoted(name) + ", allowed " + QuotedList(names) +
                     DidYouMean(name, names));
  }
  if (std::find(found + 1, names.end(), name) != names.end()) {
    throw InputError(text.Place() + ": found two columns " + Quoted(name) + ", allowed one");
  }
  return static_cast<size_t>(found - names.begin());
}

// A file that was cut off inside its last number ends with a different number, which a machine would follow.
void CheckLastNumber(const CsvText& text, size_t time_column, size_t value_column) {
  const size_t last = text.names().size() - 1;
  if (!text.unended() || (last != time_column && last != value_column)) return;
  throw text.CellError(
      last, "a number before the end of a line: the file may be cut within it; look at it, and end the line");
}

double FiniteNumber(const CsvText& text, size_t column) {
  const std::optional<double> value = text.Number(column);
  if (!value.has_value() || !std::isfinite(*value)) throw text.CellError(column, "a finite number");
  return *value;
}

// Chooses the plain layout unless only the other layout (semicolons or tabs between cells, decimal commas)
// has the column of times.
CsvLayout LayoutOf(const std::string& text, const std::string& file, const std::string& column) {
  const CsvText plain(text, file);
  const auto is_time = [](const std::string& name) { return Trimmed(name) == "time_s"; };
  if (std::any_of(plain.names().begin(), plain.names().end(), is_time)) return {};
  return FindLayout(text, file, {}, {.names = {"time_s", column}});
}

}  // namespace

std::vector<trajectory::Step> ParseCsvPoints(const std::string& text, const std::string& file,
                                             const std::string& column) {
  CsvText rows(text, file, LayoutOf(text, file, column));
  const size_t time_column = ColumnOf(rows, "time_s");
  const size_t value_column = ColumnOf(rows, column);
  std::vector<trajectory::Step> points;
  while (rows.Next()) {
    const double time = FiniteNumber(rows, time_column);
    const double value = FiniteNumber(rows, value_column);
    CheckLastNumber(rows, time_column, value_column);
    if (!points.empty() && time <= points.back().time) {
      throw rows.CellError(time_column,
                           "above " + ShortestNumber(points.back().time) + ", the time of the row before");
    }
    points.push_back({time, value});
  }
  return points;
}

std::vector<trajectory::Step> ReadCsvPoints(const std::string& file, const std::string& column) {
  return ParseCsvPoints(ReadTextFile(file), file, column);
}

}  // namespace hydro::settings
