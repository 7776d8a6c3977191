// A CSV file holds one table: the run's, or the messages of one channel. With several runs, a first column
// names the run. A folder holds one file for each table.
#include <algorithm>
#include <cmath>
#include <set>

#include "base/input_error.h"
#include "base/new_folder.h"
#include "base/number_text.h"
#include "base/units.h"
#include "runs/exports/output.h"
#include "runs/exports/sheet_units.h"
#include "runs/exports/write_export.h"

namespace hydro::exports {
namespace {

constexpr size_t kWriteChunk = 1u << 20;

// Adds quotes where a reader would otherwise misread the text.
void AppendText(const std::string& value, std::string* text) {
  if (value.find_first_of(",\"\r\n") == std::string::npos) {
    *text += value;
    return;
  }
  *text += '"';
  for (const char c : value) {
    if (c == '"') *text += '"';
    *text += c;
  }
  *text += '"';
}

class CellWriter {
 public:
  CellWriter(size_t row, Missing missing, std::string* text) : row_(row), missing_(missing), text_(*text) {}

  template <class T>
  void operator()(const std::vector<T>& values) {
    Cell(values[row_]);
  }

 private:
  void Cell(int64_t value) { text_ += std::to_string(value); }
  void Cell(double value) {
    if (!std::isnan(value) || missing_ == Missing::kNan) AppendNumber(value, text_);
  }
  void Cell(const std::string& value) { AppendText(value, &text_); }
  // A list is one cell, with blanks between its elements.
  template <class T>
  void Cell(const std::vector<T>& list) {
    std::string cell;
    for (const T& element : list) {
      if (!cell.empty()) cell += ' ';
      if constexpr (std::is_same_v<T, std::string>) {
        cell += element;
      } else if constexpr (std::is_same_v<T, double>) {
        AppendNumber(element, cell);
      } else {
        cell += std::to_string(element);
      }
    }
    AppendText(cell, &text_);
  }

  size_t row_;
  Missing missing_;
  std::string& text_;
};

// The column's heading. A channel's column includes its unit, because a CSV file has no other place for it;
// the names of the table's columns already do.
std::string Heading(const Sheet& sheet, const definitions::Field& field) {
  if (sheet.is_table || field.unit.empty()) return field.name;
  const std::string unit = "_" + UnitInName(field.unit);
  return field.name.ends_with(unit) ? field.name : field.name + unit;
}

// The sheet's columns, each name once, because a state has a time_s of its own.
std::vector<SheetColumn> ColumnsOf(const Sheet& sheet) {
  std::vector<SheetColumn> columns;
  for (SheetColumn& column : WithTimes(sheet)) {
    column.field.name = Heading(sheet, column.field);
    const auto same = [&](const SheetColumn& one) { return one.field.name == column.field.name; };
    if (std::none_of(columns.begin(), columns.end(), same)) columns.push_back(std::move(column));
  }
  return columns;
}

std::string HeadLine(const std::vector<SheetColumn>& columns, bool several) {
  std::string line = several ? "run" : "";
  for (const SheetColumn& column : columns) {
    if (!line.empty()) line += ',';
    line += column.field.name;
  }
  return line + '\n';
}

void WriteRows(const ExportedRun& run, const std::vector<SheetColumn>& columns, bool several, size_t rows,
               Missing missing, Output* out) {
  std::string text;
  // With only one column, a line with an empty cell would be an empty line.
  if (columns.size() == 1) missing = Missing::kNan;
  for (size_t row = 0; row < rows; ++row) {
    if (several) AppendText(run.name, &text);
    for (size_t i = 0; i < columns.size(); ++i) {
      if (i > 0 || several) text += ',';
      std::visit(CellWriter(row, missing, &text), columns[i].values);
    }
    text += '\n';
    if (text.size() < kWriteChunk) continue;
    out->Write(text);
    text.clear();
  }
  out->Write(text);
}

void CheckOneSheet(const std::vector<ExportedRun>& runs) {
  for (const ExportedRun& run : runs) {
    if (run.sheets.size() == 1) continue;
    std::string names;
    for (const Sheet& sheet : run.sheets) names += (names.empty() ? "" : ", ") + sheet.name;
    throw InputError(
        "found " + std::to_string(run.sheets.size()) + " tables to export (" + names +
        "), allowed is one in a file of CSV; take -o FOLDER/ for a file of each, or mat, hdf5 or mcap");
  }
}

// Writes the sheets of that name, from all runs that have one.
void WriteTable(const std::vector<ExportedRun>& runs, const std::string& name, Missing missing,
                const std::string& file) {
  Output out(file, true);
  std::string head, first;
  for (const ExportedRun& run : runs) {
    const auto sheet = std::find_if(run.sheets.begin(), run.sheets.end(),
                                    [&](const Sheet& one) { return one.name == name; });
    if (sheet == run.sheets.end()) continue;
    const std::vector<SheetColumn> columns = ColumnsOf(*sheet);
    const std::string line = HeadLine(columns, runs.size() > 1);
    if (head.empty()) {
      head = line;
      first = run.files.front();
      out.Write(head);
    } else if (line != head) {
      throw InputError(run.files.front() + ": found other units than in " + first +
                       ", allowed in one CSV are runs of the same");
    }
    WriteRows(run, columns, runs.size() > 1, sheet->rows(), missing, &out);
  }
  out.Finish();
}

}  // namespace

void WriteCsvExport(const std::vector<ExportedRun>& runs, Missing missing, const std::string& file) {
  if (!IsFolder(file)) {
    CheckOneSheet(runs);
    WriteTable(runs, runs.front().sheets.front().name, missing, file);
    return;
  }
  NewFolder folder(file);
  std::set<std::string> names;
  for (const ExportedRun& run : runs) {
    for (const Sheet& sheet : run.sheets) names.insert(sheet.name);
  }
  for (const std::string& name : names) WriteTable(runs, name, missing, folder.path() + "/" + name + ".csv");
  folder.Finish();
}

}  // namespace hydro::exports
