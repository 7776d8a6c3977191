#include <cmath>
#include <limits>

#include "base/input_error.h"
#include "base/mapped_file.h"
#include "base/new_file.h"
#include "base/number_text.h"
#include "tables/table.h"

namespace hydro::tables {
namespace {

constexpr size_t kWriteChunk = 1u << 20;
constexpr size_t kLongestQuote = 40;  // characters of a bad cell that a message shows

std::string_view Trim(std::string_view text) {
  const auto blank = [](char c) { return c == ' ' || c == '\t'; };
  while (!text.empty() && blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && blank(text.back())) text.remove_suffix(1);
  return text;
}

// A cell for a message: on one line, and not too much of it.
std::string Quoted(std::string_view cell) {
  std::string text = "'";
  for (const char c : cell.substr(0, kLongestQuote)) text += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
  return text + (cell.size() > kLongestQuote ? "...'" : "'");
}

// Takes the next line off `text`, without its end.
std::string_view TakeLine(std::string_view& text) {
  const size_t end = text.find('\n');
  std::string_view line = text.substr(0, end);
  text = end == std::string_view::npos ? std::string_view() : text.substr(end + 1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

// Takes the next cell off `line`; false when there is none left. `done` keeps that between calls.
bool TakeCell(std::string_view& line, bool& done, std::string_view& cell) {
  if (done) return false;
  size_t end;
  const size_t first = line.find_first_not_of(" \t");
  const size_t quote = first != std::string_view::npos && line[first] == '"' ? line.find('"', first + 1)
                                                                             : std::string_view::npos;
  if (quote != std::string_view::npos) {
    end = line.find(',', quote);
    cell = Trim(line.substr(0, end));
    if (cell.size() >= 2 && cell.back() == '"') cell = cell.substr(1, cell.size() - 2);
  } else {
    end = line.find(',');
    cell = Trim(line.substr(0, end));
  }
  done = end == std::string_view::npos;
  if (!done) line.remove_prefix(end + 1);
  return true;
}

void ReadNames(std::string_view line, Table& table) {
  std::string_view cell;
  for (bool done = false; TakeCell(line, done, cell);) {
    const std::string place =
        table.file + ": line 1, column " + std::to_string(table.columns.size() + 1) + ": ";
    if (cell.empty()) throw InputError(place + "found no name; every column needs one");
    if (table.Find(cell) != nullptr) {
      throw InputError(place + "found the name " + Quoted(cell) +
                       " a second time; each name is allowed once");
    }
    table.columns.push_back({std::string(cell), {}});
  }
}

double ReadCell(std::string_view cell, const Table& table, size_t row, size_t column) {
  if (cell.empty()) return std::numeric_limits<double>::quiet_NaN();
  const std::optional<double> value = ParseNumber(cell);
  if (!value.has_value()) {
    throw InputError(table.Place(row, table.columns[column].name) + ": found " + Quoted(cell) +
                     "; a number, nan or an empty cell is allowed");
  }
  return *value;
}

}  // namespace

Table ReadCsv(const std::string& file) {
  const MappedFile contents(file);
  std::string_view text(reinterpret_cast<const char*>(contents.data()), contents.size());
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  Table table;
  table.file = file;
  table.rows_are_lines = true;
  if (Trim(text).empty()) throw InputError(file + ": found an empty file; a line of column names is needed");
  ReadNames(TakeLine(text), table);

  size_t row = 0;
  for (; !text.empty(); ++row) {
    std::string_view line = TakeLine(text);
    const std::string line_name = file + ": line " + std::to_string(row + 2);
    if (Trim(line).empty() && table.columns.size() > 1) {
      if (text.find_first_not_of(" \t\r\n") == std::string_view::npos) break;  // blank lines at the end
      throw InputError(line_name + ": found an empty line; " + std::to_string(table.columns.size()) +
                       " cells are needed");
    }
    size_t count = 0;
    std::string_view cell;
    for (bool done = false; TakeCell(line, done, cell); ++count) {
      if (count < table.columns.size())
        table.columns[count].values.push_back(ReadCell(cell, table, row, count));
    }
    if (count != table.columns.size()) {
      throw InputError(line_name + ": found " + std::to_string(count) + " cells; " +
                       std::to_string(table.columns.size()) + " are needed, as many as there are names");
    }
  }
  if (row == 0) throw InputError(file + ": line 2: found no rows; at least one is needed below the names");
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
      // A line of nothing but a missing value would be an empty line.
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
