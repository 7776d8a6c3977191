#include "base/tables/csv_cells.h"

#include <algorithm>
#include <array>
#include <iterator>

#include "base/number_text.h"
#include "base/unit_system.h"
#include "base/units.h"

namespace hydro::tables {
namespace {

constexpr std::string_view kBlanks = " \t";

size_t FindSeparator(std::string_view line, char separator, size_t from) {
  return separator == ' ' ? line.find_first_of(kBlanks, from) : line.find(separator, from);
}

// The quote that closes the one at `opening`: the first that does not belong to a pair; npos when there is
// none.
size_t ClosingQuote(std::string_view text, size_t opening) {
  size_t quote = text.find('"', opening + 1);
  while (quote != std::string_view::npos && text.substr(quote + 1).starts_with('"')) {
    quote = text.find('"', quote + 2);
  }
  return quote;
}

// A cell that begins with a quote ends at the separator after its closing quote.
size_t EndOfCell(std::string_view line, char separator) {
  const size_t first = line.find_first_not_of(kBlanks);
  if (first == std::string_view::npos || line[first] != '"') return FindSeparator(line, separator, 0);
  const size_t closing = ClosingQuote(line, first);
  return FindSeparator(line, separator, closing == std::string_view::npos ? 0 : closing);
}

// Whether a quote at this place may open a cell, for any separator.
bool MayOpen(std::string_view text, size_t quote) {
  const size_t before = text.substr(0, quote).find_last_not_of(' ');
  return before == std::string_view::npos ||
         std::string_view(",;\t\n").find(text[before]) != std::string_view::npos;
}

bool IsNumber(std::string_view cell) {
  return ParseNumber(cell).has_value() || ParseDecimalComma(cell).has_value();
}

// Units of quantities that no signal measures, and of pressures that count from another zero.
constexpr std::string_view kOthers[] = {"A",      "mA",     "%",     "°C",    "degC",  "C",    "K",    "W",
                                        "kW",     "g",      "l/min", "L/min", "psig",  "psia", "barg", "bara",
                                        "bar(g)", "bar(a)", "1/min", "m/s²",  "m/s^2", "dB"};

std::string_view WithoutBrackets(std::string_view cell) {
  cell = Trimmed(cell);
  if (cell.size() < 2) return cell;
  const bool bracketed =
      (cell.front() == '[' && cell.back() == ']') || (cell.front() == '(' && cell.back() == ')');
  return bracketed ? Trimmed(cell.substr(1, cell.size() - 2)) : cell;
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

size_t EndOfLine(std::string_view text) {
  constexpr std::ptrdiff_t kMostLines = 10;  // in a cell
  constexpr size_t kLongestCell = 1u << 16;  // limits the search in each line
  size_t end = text.find('\n');
  if (end < text.size() - std::min(text.size(), kLongestCell)) text = text.substr(0, end + kLongestCell);
  for (size_t quote = text.find('"'); quote < end; quote = text.find('"', quote + 1)) {
    if (!MayOpen(text, quote)) continue;
    const size_t closing = ClosingQuote(text, quote);
    if (closing == std::string_view::npos) return end;
    if (closing > end) {
      const std::string_view cell = text.substr(quote, closing - quote);
      if (std::count(cell.begin(), cell.end(), '\n') > kMostLines) return end;
      end = text.find('\n', closing);
    }
    quote = closing;
  }
  return end;
}

std::string CellText(std::string_view cell) {
  if (cell.size() < 2 || cell.front() != '"' || cell.back() != '"') return std::string(cell);
  std::string text;
  for (size_t i = 1; i + 1 < cell.size(); ++i) {
    text += cell[i];
    if (cell[i] == '"' && i + 2 < cell.size() && cell[i + 1] == '"') ++i;
  }
  return text;
}

void SplitCells(std::string_view line, char separator, std::vector<std::string_view>& cells) {
  cells.clear();
  if (separator == ' ') line = Trimmed(line);
  for (;;) {
    const size_t end = EndOfCell(line, separator);
    std::string_view cell = Trimmed(line.substr(0, end));
    const bool quoted = cell.size() >= 2 && cell.front() == '"';
    if (quoted && cell.find('"', 1) == cell.size() - 1) cell = cell.substr(1, cell.size() - 2);
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

const char* NameOf(char separator) {
  switch (separator) {
    case ';':
      return "semicolons";
    case '\t':
      return "tabs";
    case ' ':
      return "blanks";
    default:
      return "commas";
  }
}

Lines LinesOf(std::string_view text, char separator, size_t skip, size_t most) {
  Lines lines;
  for (size_t number = 1; !text.empty() && lines.size() < most; ++number) {
    // The skipped lines may hold any text, with any quotes.
    const size_t end = number <= skip ? text.find('\n') : EndOfLine(text);
    const std::string_view whole = text.substr(0, end);
    const std::string_view line = WithoutEnd(whole, separator);
    text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
    if (number > skip && !line.empty()) lines.push_back({line, number, line.front() == '#'});
    number += static_cast<size_t>(std::count(whole.begin(), whole.end(), '\n'));
  }
  return lines;
}

std::vector<std::string_view> CellsOf(const Line& line, char separator) {
  std::vector<std::string_view> cells;
  SplitCells(line.text, separator, cells);
  return cells;
}

bool AllNumbers(const std::vector<std::string_view>& cells) {
  bool any = false;
  for (const std::string_view cell : cells) {
    if (cell.empty()) continue;
    if (!IsNumber(cell)) return false;
    any = true;
  }
  return any;
}

std::string UnitOfCell(std::string_view cell) { return std::string(OurSpelling(WithoutBrackets(cell))); }

bool IsUnitCell(std::string_view cell) {
  if (WithoutBrackets(cell).size() != Trimmed(cell).size()) return true;
  const std::string unit = UnitOfCell(cell);
  return ParseUnit(unit).has_value() ||
         std::find(std::begin(kOthers), std::end(kOthers), unit) != std::end(kOthers);
}

}  // namespace hydro::tables
