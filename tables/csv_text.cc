#include "tables/csv_text.h"

#include <algorithm>
#include <utility>

#include "base/interruption.h"
#include "base/number_text.h"
#include "base/text_file.h"

namespace hydro::tables {
CsvText::CsvText(std::string_view text, std::string file, const CsvLayout& layout)
    : text_(text), file_(std::move(file)), layout_(layout) {
  text_ = WithoutByteOrderMark(text_);
  std::string_view line;
  while (taken_ < layout_.skip_lines && !text_.empty()) TakeRawLine(&line);
  comment_ = {};
  const bool found = TakeLine(&line);
  if (found) SplitCells(line, layout_.separator, cells_);
  if (!comment_.empty() && (!found || AllNumbers())) {
    waiting_ = line;
    waiting_line_ = line_;
    line_ = comment_line_;
    SplitCells(comment_, layout_.separator, cells_);
  } else if (!found) {
    throw InputError(file_ + ": found no line of column names, allowed one above the rows");
  }
  names_ = cells_;
  if (layout_.units_row) ReadUnits();
}

void CsvText::ReadUnits() {
  const size_t line = line_;
  if (!TakeRow()) throw InputError(file_ + ": found no row of units, allowed one below the column names");
  units_ = cells_;
  cells_ = names_;
  line_ = line;
}

void CsvText::TakeRawLine(std::string_view* line) {
  const size_t end = text_.find('\n');
  *line = WithoutEnd(text_.substr(0, end), layout_.separator);
  text_.remove_prefix(end == std::string_view::npos ? text_.size() : end + 1);
  ++taken_;
}

bool CsvText::TakeLine(std::string_view* line) {
  while (!text_.empty()) {
    TakeRawLine(line);
    line_ = taken_;
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
  Interruption::Check();
  if (!TakeRow()) {
    if (any_row_) return false;
    throw InputError(file_ + ": found no rows, allowed one or more below the column names");
  }
  any_row_ = true;
  return true;
}

bool CsvText::TakeRow() {
  std::string_view line = std::exchange(waiting_, {});
  if (!line.empty()) {
    line_ = waiting_line_;
  } else if (!TakeLine(&line)) {
    return false;
  }
  SplitCells(line, layout_.separator, cells_);
  if (cells_.size() != names_.size()) {
    throw InputError(Place() + ": found " + std::to_string(cells_.size()) + " cells, allowed " +
                     std::to_string(names_.size()) + ", as many as there are names");
  }
  return true;
}

std::optional<double> CsvText::Number(size_t column) const {
  const std::string_view cell = Trimmed(cells_[column]);
  if (layout_.decimal == ',' && cell.find_first_of(".,") != std::string_view::npos)
    return ParseDecimalComma(cell);
  return ParseNumber(cell);
}

std::string CsvText::Place() const { return file_ + ": line " + std::to_string(line_); }

InputError CsvText::CellError(size_t column, const std::string& allowed) const {
  return InputError(Place() + ", column " + std::string(names_[column]) + ": found " +
                    Quoted(cells_[column]) + ", allowed " + allowed);
}

}  // namespace hydro::tables
