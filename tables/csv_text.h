// CSV text, row by row.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/input_error.h"

namespace hydro::tables {

// The grammar of every CSV file that this project reads. Cells stand between commas, and may be quoted, with
// commas inside. A byte order mark, blanks around cells, carriage returns, blank lines (which in a table of
// one column are an empty cell) and lines that begin with # are skipped. The first line that remains holds
// the names, unless it holds numbers and lines with # came before: then the last of those has the names
// ("#time,p1").
class CsvText {
 public:
  // Reads the names; `file` is for messages. The text must outlive the reader. Throws InputError where there
  // is no line of names.
  CsvText(std::string_view text, std::string file);

  const std::vector<std::string_view>& names() const { return names_; }

  // Goes on to the next row; false when there is none left. Throws InputError for a row that has not as many
  // cells as there are names, and where there is no row at all.
  bool Next();

  std::string_view cell(size_t column) const { return cells_[column]; }
  // The cell as a number; empty when it is none.
  std::optional<double> Number(size_t column) const;

  size_t line() const { return line_; }  // of the row, or of the names before the first Next()
  // "run.csv: line 17"
  std::string Place() const;
  // "run.csv: line 17, column p1_psi: found "x", allowed ..."
  InputError CellError(size_t column, const std::string& allowed) const;

 private:
  // Takes the next line that is not skipped off the text.
  bool TakeLine(std::string_view* line);
  bool AllNumbers() const;

  std::string_view text_;
  std::string file_;
  std::vector<std::string_view> names_;
  std::vector<std::string_view> cells_;
  std::string_view comment_;  // the last line with #
  std::string_view waiting_;  // a line that was read as names and is a row
  size_t line_ = 0;
  size_t comment_line_ = 0;
  size_t waiting_line_ = 0;
  bool any_row_ = false;
};

// Without the blanks and carriage returns at its ends.
std::string_view Trimmed(std::string_view text);

}  // namespace hydro::tables
