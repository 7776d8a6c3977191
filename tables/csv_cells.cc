#include "tables/csv_cells.h"

#include <algorithm>
#include <array>

#include "base/number_text.h"

namespace hydro::tables {
namespace {

constexpr std::string_view kBlanks = " \t";

size_t FindSeparator(std::string_view line, char separator, size_t from) {
  return separator == ' ' ? line.find_first_of(kBlanks, from) : line.find(separator, from);
}

// A cell that begins with a quote ends at the separator after the next quote.
size_t EndOfCell(std::string_view line, char separator) {
  const size_t first = line.find_first_not_of(kBlanks);
  if (first == std::string_view::npos || line[first] != '"') return FindSeparator(line, separator, 0);
  const size_t closing = line.find('"', first + 1);
  return FindSeparator(line, separator, closing == std::string_view::npos ? 0 : closing);
}

}  // namespace

std::string_view Trimmed(std::string_view text) {
  const size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::string_view WithoutByteOrderMark(std::string_view text) {
  constexpr std::string_view kMark = "\xef\xbb\xbf";
  if (text.starts_with(kMark)) text.remove_prefix(kMark.size());
  return text;
}

std::string_view WithoutEnd(std::string_view line, char separator) {
  const std::string_view trimmed = Trimmed(line);
  if (separator != '\t' || trimmed.empty() || trimmed.front() == '#') return trimmed;
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

void SplitCells(std::string_view line, char separator, std::vector<std::string_view>& cells) {
  cells.clear();
  if (separator == ' ') line = Trimmed(line);
  for (;;) {
    const size_t end = EndOfCell(line, separator);
    std::string_view cell = Trimmed(line.substr(0, end));
    if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"') cell = cell.substr(1, cell.size() - 2);
    cells.push_back(cell);
    if (end == std::string_view::npos) return;
    line.remove_prefix(end + 1);
    if (separator == ' ') line = Trimmed(line);
  }
}

std::optional<double> ParseDecimalComma(std::string_view text) {
  constexpr size_t kLongest = 64;  // no number needs more
  std::array<char, kLongest> copy;
  if (text.size() > copy.size() || std::count(text.begin(), text.end(), ',') != 1) return std::nullopt;
  if (text.find('.') != std::string_view::npos) return std::nullopt;
  std::replace_copy(text.begin(), text.end(), copy.begin(), ',', '.');
  return ParseNumber({copy.data(), text.size()});
}

}  // namespace hydro::tables
