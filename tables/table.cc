#include "tables/table.h"

#include "base/input_error.h"
#include "base/text_file.h"

namespace hydro::tables {

const Column* Table::Find(std::string_view name) const {
  for (const Column& column : columns) {
    if (column.name == name) return &column;
  }
  return nullptr;
}

std::string Table::Place(size_t row, std::string_view column) const {
  return file + ": " +
         (lines.empty() ? "row " + std::to_string(row + 1) : "line " + std::to_string(lines[row])) +
         ", column " + std::string(column);
}

Table ReadTable(const std::string& file, const CsvSettings& settings) {
  return file.ends_with(".mat") ? ReadMat(file) : ReadCsv(file, settings);
}

Table ReadTableWithoutUnits(const std::string& file) {
  Table table = ReadTable(file);
  for (const Column& column : table.columns) {
    if (column.unit.empty()) continue;
    throw InputError(file + ": column " + column.name + ": found the unit " + Quoted(column.unit) +
                     " in a row of units, allowed columns whose names say their units, and no such row");
  }
  return table;
}

void CheckTableName(const std::string& file) {
  if (file.ends_with(".csv") || file.ends_with(".mat")) return;
  throw InputError(
      file + ": found a name that tells no format of table; allowed are names that end in .csv or .mat");
}

void WriteTable(const Table& table, const std::string& file) {
  CheckTableName(file);
  file.ends_with(".mat") ? WriteMat(table, file) : WriteCsv(table, file);
}

}  // namespace hydro::tables
