#include "tables/csv_text.h"

#include <algorithm>
#include <utility>

#include "base/number_text.h"
#include "base/text_file.h"

namespace hydro::tables {
namespace {

constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";

// A cell that begins with a quote ends at the comma after the next quote. An unclosed quote is an ordinary
// character.
size_t EndOfCell(std::string_view line) {
  const size_t first = line.find_first_not_of(" \t");
  if (first == std::string_view::npos || line[first] != '"') return line.find(',');
  const size_t closing = line.find('"', first + 1);
  return line.find(',', closing == std::string_view::npos ? 0 : closing);
}

void SplitCells(std::string_view line, std::vector<std::string_view>& cells) {
  cells.clear();
  for (;;) {
    const size_t end = EndOfCell(line);
    std::string_view cell = Trimmed(line.substr(0, end));
    if (cell.size() >= 2 && cell.front() == '"' && cell.back() == '"') cell = cell.substr(1, cell.size() - 2);
    cells.push_back(cell);
    if (end == std::string_view::npos) return;
    line.remove_prefix(end + 1);
  }
}

}  // namespace

std::string_view Trimmed(std::string_view text) {
  const size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

CsvText::CsvText(std::string_view text, std::string file) : text_(text), file_(std::move(file)) {
  if (text_.starts_with(kByteOrderMark)) text_.remove_prefix(kByteOrderMark.size());
  std::string_view line;
  const bool found = TakeLine(&line);
  if (found) SplitCells(line, cells_);
  if (!comment_.empty() && (!found || AllNumbers())) {
    waiting_ = line;
    waiting_line_ = line_;
    line_ = comment_line_;
    SplitCells(comment_, cells_);
  } else if (!found) {
    throw InputError(file_ + ": found no line of column names, allowed one above the rows");
  }
  names_ = cells_;
}

bool CsvText::TakeLine(std::string_view* line) {
  while (!text_.empty()) {
    const size_t end = text_.find('\n');
    *line = Trimmed(text_.substr(0, end));
    text_.remove_prefix(end == std::string_view::npos ? text_.size() : end + 1);
    ++line_;
    if (line->starts_with('#')) {
      comment_ = *line;
      comment_line_ = line_;
    } else if (!line->empty() || names_.size() == 1) {
      return true;
    }
  }
  *line = {};
  return false;
}

bool CsvText::AllNumbers() const {
  for (size_t i = 0; i < cells_.size(); ++i) {
    if (!cells_[i].empty() && !Number(i).has_value()) return false;
  }
  return true;
}

bool CsvText::Next() {
  std::string_view line = std::exchange(waiting_, {});
  if (!line.empty()) {
    line_ = waiting_line_;
  } else if (!TakeLine(&line)) {
    if (any_row_) return false;
    throw InputError(file_ + ": found no rows, allowed one or more below the column names");
  }
  any_row_ = true;
  SplitCells(line, cells_);
  if (cells_.size() != names_.size()) {
    throw InputError(Place() + ": found " + std::to_string(cells_.size()) + " cells, allowed " +
                     std::to_string(names_.size()) + ", as many as there are names");
  }
  return true;
}

std::optional<double> CsvText::Number(size_t column) const { return ParseNumber(Trimmed(cells_[column])); }

std::string CsvText::Place() const { return file_ + ": line " + std::to_string(line_); }

InputError CsvText::CellError(size_t column, const std::string& allowed) const {
  return InputError(Place() + ", column " + std::string(names_[column]) + ": found " +
                    Quoted(cells_[column]) + ", allowed " + allowed);
}

}  // namespace hydro::tables
