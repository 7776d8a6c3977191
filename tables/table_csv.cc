#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "base/mapped_file.h"
#include "base/new_file.h"
#include "base/number_text.h"
#include "base/text_file.h"
#include "tables/csv_text.h"
#include "tables/table.h"
#include "tables/text_encoding.h"
#include "tables/unit_cells.h"

namespace hydro::tables {
namespace {

constexpr size_t kWriteChunk = 1u << 20;

void CheckNames(const CsvText& text, const std::vector<Column>& columns) {
  for (size_t i = 0; i < columns.size(); ++i) {
    const auto refuse = [&](const std::string& found, const std::string& allowed) {
      throw InputError(text.Place() + ", column " + std::to_string(i + 1) + ": found " + found +
                       ", allowed " + allowed);
    };
    const std::string& name = columns[i].name;
    if (name.empty()) refuse("no name", "a name for every column");
    const auto same = [&name](const Column& column) { return column.name == name; };
    if (std::any_of(columns.begin(), columns.begin() + static_cast<std::ptrdiff_t>(i), same)) {
      refuse("the name " + Quoted(name) + " a second time", "each name once");
    }
  }
}

// An export of several runs has a first column that names them (exports/csv_export.h).
std::string AllowedIn(const std::string& column) {
  std::string allowed = "a number, nan or an empty cell";
  if (column != "run") return allowed;
  return allowed +
         ": this is a table of several runs; export one, a limb's joint with hydro-log export --joint NAME";
}

}  // namespace

Table ReadCsv(const std::string& file, const CsvSettings& settings) {
  const MappedFile contents(file);
  std::string_view bytes(reinterpret_cast<const char*>(contents.data()), contents.size());
  const std::optional<std::string> utf8 = FromUtf16(bytes, file);
  if (utf8.has_value()) bytes = *utf8;
  const CsvLayout layout = FindLayout(bytes, file, settings);
  CsvText text(bytes, file, layout);
  Table table;
  table.file = file;
  table.layout = Described(layout);
  if (utf8.has_value()) table.layout = table.layout.empty() ? "UTF-16" : "UTF-16, " + table.layout;
  // A separator at the end of every line leaves a column that is none.
  const size_t columns =
      text.names().size() - (text.names().size() > 1 && text.names().back().empty() ? 1 : 0);
  for (size_t i = 0; i < columns; ++i) {
    table.columns.push_back({std::string(text.names()[i]), {}});
    if (layout.units_row) table.columns.back().unit = UnitOfCell(text.units()[i]);
  }
  CheckNames(text, table.columns);
  while (text.Next()) {
    table.lines.push_back(text.line());
    if (columns < text.names().size() && !text.cell(columns).empty()) {
      throw text.CellError(columns, "an empty cell, as the column has no name");
    }
    for (size_t i = 0; i < columns; ++i) {
      const bool missing = text.cell(i).empty();
      const std::optional<double> value = missing ? std::numeric_limits<double>::quiet_NaN() : text.Number(i);
      if (!value.has_value()) throw text.CellError(i, AllowedIn(table.columns[i].name));
      table.columns[i].values.push_back(*value);
    }
  }
  return table;
}

void WriteCsv(const Table& table, const std::string& file) {
  NewFile out(file, Opening::kTemporary);
  std::string text;
  for (const Column& column : table.columns) {
    if (!text.empty()) text += ',';
    text += column.name;
  }
  text += '\n';
  for (size_t row = 0; row < table.rows(); ++row) {
    for (size_t column = 0; column < table.columns.size(); ++column) {
      if (column > 0) text += ',';
      const double value = table.columns[column].values[row];
      // A line with nothing but a missing value would be an empty line.
      if (!std::isnan(value) || table.columns.size() == 1) AppendNumber(value, text);
    }
    text += '\n';
    if (text.size() >= kWriteChunk) {
      out.Write(text.data(), text.size());
      text.clear();
    }
  }
  out.Write(text.data(), text.size());
  out.Finish();
}

}  // namespace hydro::tables
