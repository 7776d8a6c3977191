#include "tables/csv_points.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "base/did_you_mean.h"
#include "base/text_file.h"

namespace hydro::tables {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

std::string_view Trimmed(std::string_view text) {
  const size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::vector<std::string_view> Cells(std::string_view line) {
  std::vector<std::string_view> cells;
  while (true) {
    const size_t comma = line.find(',');
    std::string_view cell = Trimmed(line.substr(0, comma));
    if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"') {
      cell = Trimmed(cell.substr(1, cell.size() - 2));
    }
    cells.push_back(cell);
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

size_t ColumnOf(const std::vector<std::string_view>& header, const std::string& name,
                const std::string& place) {
  const auto found = std::find(header.begin(), header.end(), name);
  if (found == header.end()) {
    throw InputError(place + ": found no column " + Quoted(name) + ", allowed " + QuotedList(header) +
                     DidYouMean(name, std::vector<std::string>(header.begin(), header.end())));
  }
  if (std::find(found + 1, header.end(), name) != header.end()) {
    throw InputError(place + ": found two columns " + Quoted(name) + ", allowed one");
  }
  return static_cast<size_t>(found - header.begin());
}

double Number(std::string_view cell, const std::string& place) {
  double value = 0;
  std::string_view digits = cell;
  if (!digits.empty() && digits.front() == '+') digits.remove_prefix(1);
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value)) {
    throw InputError(place + ": found " + Quoted(cell) + ", allowed a finite number");
  }
  return value;
}

}  // namespace

std::vector<trajectory::Step> ParseCsvPoints(const std::string& text, const std::string& file,
                                             const std::string& column) {
  std::vector<trajectory::Step> points;
  std::vector<std::string_view> header;
  size_t time_column = 0;
  size_t value_column = 0;
  std::string_view rest = text;
  if (rest.starts_with(kByteOrderMark)) rest.remove_prefix(kByteOrderMark.size());
  for (int row = 1; !rest.empty(); ++row) {
    const size_t newline = rest.find('\n');
    const std::string_view line = Trimmed(rest.substr(0, newline));
    rest.remove_prefix(newline == std::string_view::npos ? rest.size() : newline + 1);
    if (line.empty() || line.front() == '#') continue;
    const std::string place = file + ":" + std::to_string(row);
    const std::vector<std::string_view> cells = Cells(line);
    if (header.empty()) {
      header = cells;
      time_column = ColumnOf(header, "time_s", place);
      value_column = ColumnOf(header, column, place);
      continue;
    }
    if (cells.size() != header.size()) {
      throw InputError(place + ": found " + std::to_string(cells.size()) + " cells, allowed " +
                       std::to_string(header.size()) + ", as many as the header has");
    }
    const double time = Number(cells[time_column], place + ":time_s");
    const double value = Number(cells[value_column], place + ":" + column);
    if (!points.empty() && time <= points.back().time) {
      throw InputError(place + ":time_s: found " + ShortestNumber(time) + ", allowed above " +
                       ShortestNumber(points.back().time) + ", the time of the row before");
    }
    points.push_back({time, value});
  }
  if (header.empty()) {
    throw InputError(file + ": found no header row, allowed the column names time_s and " + column);
  }
  if (points.empty()) throw InputError(file + ": found no rows below the header, allowed one or more");
  return points;
}

std::vector<trajectory::Step> ReadCsvPoints(const std::string& file, const std::string& column) {
  return ParseCsvPoints(ReadTextFile(file), file, column);
}

}  // namespace hydro::tables
