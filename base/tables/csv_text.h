// Reads CSV text row by row.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/input_error.h"
#include "base/tables/csv_cells.h"
#include "base/tables/csv_layout.h"

namespace hydro::tables {

// The grammar of every CSV file that this project reads. Commas, or the separator of the layout, separate
// cells; quoted cells may contain separators. A byte order mark, blanks around cells, carriage returns, blank
// lines (which are an empty cell in a table of one column) and lines that begin with # are skipped. The first
// remaining line holds the names, unless it holds numbers and lines with # came before: then the last of
// those has the names ("#time,p1").
class CsvText {
 public:
  // Reads the names, and the units if the layout has them; `file` is for messages. The text must outlive the
  // reader. Throws InputError when there is no line of names.
  CsvText(std::string_view text, std::string file, const CsvLayout& layout = {});

  const std::vector<std::string>& names() const { return names_; }
  // One unit for each column, or none at all.
  const std::vector<std::string>& units() const { return units_; }

  // Advances to the next row; returns false when there is none left. Throws InputError for a row with more or
  // fewer cells than names, and when there is no row at all.
  bool Next();

  // Whether the row is the last line of the text and has no line end: the file may have been cut there.
  bool unended() const { return unended_; }
  // After PassOverCutRow(), a last row that is cut before its last cell is skipped and counts as the text's
  // end; cut_line() returns its line.
  void PassOverCutRow() { pass_over_cut_ = true; }
  size_t cut_line() const { return cut_line_; }

  std::string_view cell(size_t column) const { return cells_[column]; }
  // The cell as a number; empty if it is not one.
  std::optional<double> Number(size_t column) const;

  size_t line() const { return line_; }  // line of the row, or of the names before the first Next()
  // "run.csv: line 17"
  std::string Place() const;
  // "run.csv: line 17, column p1_psi: found "x", allowed ..."
  InputError CellError(size_t column, const std::string& allowed) const;

 private:
  void TakeRawLine(std::string_view* line);
  // Removes the next line that is not skipped from the text, and returns it in `line`.
  bool TakeLine(std::string_view* line);
  // Splits the next line into cells, as many as there are names; returns false when there is no line.
  bool TakeRow();
  void FindNames();
  void ReadUnits();
  // Removes the lines up to and including this one, and returns this one.
  std::string_view TakeLineOf(size_t line);
  bool AllNumbers() const;

  std::string_view text_;
  std::string file_;
  CsvLayout layout_;
  std::vector<std::string> names_;
  std::vector<std::string> units_;
  std::vector<std::string_view> cells_;
  std::string_view comment_;  // the last line with #
  std::string_view waiting_;  // a row that was read while looking for the names
  size_t taken_ = 0;          // lines removed from the text
  size_t line_ = 0;
  size_t comment_line_ = 0;
  size_t waiting_line_ = 0;
  size_t cut_line_ = 0;
  bool any_row_ = false;
  bool unended_ = false;
  bool pass_over_cut_ = false;
  bool any_quotes_ = false;  // a line ends at its line feed, even within quotes
};

}  // namespace hydro::tables
