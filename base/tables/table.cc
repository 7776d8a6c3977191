#include "base/tables/table.h"

#include <algorithm>
#include <array>
#include <filesystem>

#include "base/file_kind.h"
#include "base/input_error.h"
#include "base/mapped_file.h"
#include "base/text_file.h"

namespace hydro::tables {
namespace {

constexpr char kATable[] = "a table (CSV, or MAT named .mat)";

std::optional<FileKind> KindOf(const MappedFile& file) {
  constexpr size_t kLooked = 4096;
  return FindFileKind({reinterpret_cast<const char*>(file.data()), std::min(file.size(), kLooked)});
}

}  // namespace

const Column* Table::Find(std::string_view name) const {
  for (const Column& column : columns) {
    if (column.name == name) return &column;
  }
  return nullptr;
}

std::string Table::WhyNot(std::string_view name) const {
  for (const LeftOut& one : left_out) {
    if (one.name == name) return ": " + one.why;
  }
  return {};
}

void Table::Note(const std::string& what) { layout += (layout.empty() ? "" : ", ") + what; }

std::string Table::Place(size_t row, std::string_view column) const {
  return file + ": " +
         (lines.empty() ? "row " + std::to_string(row + 1) : "line " + std::to_string(lines[row])) +
         ", column " + std::string(column);
}

bool IsTable(const std::string& file) {
  constexpr std::array kEndings{".csv", ".tsv", ".txt", ".dat", ".mat"};
  const std::string ending = EndingOf(file);
  return std::any_of(kEndings.begin(), kEndings.end(), [&](const char* one) { return ending == one; });
}

void RequireTableName(const std::string& file) {
  if (IsTable(file)) return;
  std::optional<FileKind> kind;
  if (std::filesystem::is_regular_file(file)) kind = KindOf(MappedFile(file));
  if (kind.has_value()) throw InputError(file + ": " + OtherKind(*kind, file, kATable));
  throw InputError(
      file +
      ": found a name that tells no format of table; allowed are names that end in .csv, .tsv, .txt, .dat or "
      ".mat: rename it");
}

Table ReadTable(const std::string& file, const CsvSettings& settings, const AskedColumns& asked) {
  CheckIsFile(file);
  const bool mat = EndingOf(file) == ".mat";
  const std::optional<FileKind> kind = KindOf(MappedFile(file));
  // MAT 7.3 is HDF5, with or without MATLAB's own header.
  const bool fits = mat && (kind == FileKind::kMat || kind == FileKind::kHdf5);
  if (kind.has_value() && !fits) throw InputError(file + ": " + OtherKind(*kind, file, kATable));
  return mat ? ReadMat(file, asked) : ReadCsv(file, settings, asked);
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

void TakeStructOf(std::string_view name, Table* table) {
  const std::string ending = "." + std::string(name);
  const auto holds = [&](const Column& column) { return column.name.ends_with(ending); };
  if (table->Find(name) != nullptr || std::count_if(table->columns.begin(), table->columns.end(), holds) != 1)
    return;
  const std::string& found = std::find_if(table->columns.begin(), table->columns.end(), holds)->name;
  const std::string prefix = found.substr(0, found.size() - name.size());
  std::vector<Column> columns;
  for (Column& column : table->columns) {
    if (column.name.starts_with(prefix) && column.name.find('.', prefix.size()) == std::string::npos) {
      column.name.erase(0, prefix.size());
      columns.push_back(std::move(column));
    } else {
      table->left_out.push_back({column.name, "found outside the struct of " + std::string(name)});
    }
  }
  table->columns = std::move(columns);
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
