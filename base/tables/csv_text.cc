#include "base/tables/csv_text.h"

#include <algorithm>
#include <utility>

#include "base/interruption.h"
#include "base/number_text.h"
#include "base/text_file.h"

namespace hydro::tables {
CsvText::CsvText(std::string_view text, std::string file, const CsvLayout& layout)
    : text_(text), file_(std::move(file)), layout_(layout) {
  text_ = WithoutByteOrderMark(text_);
  if (layout_.names_line == 0) {
    FindNames();
    if (layout_.units_row) ReadUnits();
    return;
  }
  SplitCells(TakeLineOf(layout_.names_line), layout_.separator, cells_);
  for (const std::string_view cell : cells_) names_.push_back(CellText(cell));
  const size_t names_line = line_;
  if (layout_.units_line > 0) {
    SplitCells(TakeLineOf(layout_.units_line), layout_.separator, cells_);
    for (const std::string_view cell : cells_) units_.push_back(CellText(cell));
    units_.resize(names_.size());
  }
  std::string_view line;
  while (taken_ + 1 < layout_.first_row && !text_.empty()) TakeRawLine(&line);
  line_ = names_line;
}

std::string_view CsvText::TakeLineOf(size_t line) {
  std::string_view text;
  do {
    // The lines before the names may hold any text, with any quotes.
    any_quotes_ = taken_ + 1 < layout_.names_line;
    TakeRawLine(&text);
  } while (line_ < line && !text_.empty());
  any_quotes_ = false;
  return text;
}

void CsvText::FindNames() {
  std::string_view line;
  any_quotes_ = true;
  while (taken_ < layout_.skip_lines && !text_.empty()) TakeRawLine(&line);
  any_quotes_ = false;
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
  for (const std::string_view cell : cells_) names_.push_back(CellText(cell));
}

void CsvText::ReadUnits() {
  const size_t line = line_;
  if (!TakeRow()) throw InputError(file_ + ": found no row of units, allowed one below the column names");
  for (const std::string_view cell : cells_) units_.push_back(CellText(cell));
  line_ = line;
}

void CsvText::TakeRawLine(std::string_view* line) {
  const size_t end = any_quotes_ ? text_.find('\n') : EndOfLine(text_);
  const std::string_view whole = text_.substr(0, end);
  *line = WithoutEnd(whole, layout_.separator);
  unended_ = end == std::string_view::npos;
  text_.remove_prefix(unended_ ? text_.size() : end + 1);
  line_ = taken_ + 1;
  taken_ = line_ + static_cast<size_t>(std::count(whole.begin(), whole.end(), '\n'));
}

bool CsvText::TakeLine(std::string_view* line) {
  while (!text_.empty()) {
    TakeRawLine(line);
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
    if (any_row_ || cut_line_ > 0) return false;
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
  if (pass_over_cut_ && unended_ && cells_.size() < names_.size()) {
    cut_line_ = line_;
    return false;
  }
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
  const bool begins_again = cells_[column] == names_[column];
  return InputError(Place() + ", column " + names_[column] + ": found " + Quoted(cells_[column]) +
                    ", allowed " + allowed +
                    (begins_again ? "; where the names stand again, cut the table in two" : ""));
}

}  // namespace hydro::tables
