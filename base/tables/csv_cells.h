// Splits CSV text into lines and cells, and recognises cells with units as recorders write them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hydro::tables {

// The text without blanks and carriage returns at both ends.
std::string_view Trimmed(std::string_view text);

// The text without the byte order mark of UTF-8.
std::string_view WithoutByteOrderMark(std::string_view text);

// The line without its end. Tabs at its ends are cells when tabs separate cells.
std::string_view WithoutEnd(std::string_view line, char separator);

// The end of the first line of a text: its line feed, or the end of the text. A line feed in a quoted cell is
// a part of it (RFC 4180); a quote that is not closed within a few lines is an ordinary character.
size_t EndOfLine(std::string_view text);

// Splits a line at each separator; ' ' stands for runs of blanks and tabs. Quoted cells may contain the
// separator. They lose their quotes unless they contain further ones, which CellText() resolves. An unclosed
// quote is an ordinary character.
void SplitCells(std::string_view line, char separator, std::vector<std::string_view>& cells);

// The text of a cell: in a quoted cell, two quotes stand for one (RFC 4180).
std::string CellText(std::string_view cell);

// A number with a decimal comma, and neither a point nor a second comma: "0,5".
std::optional<double> ParseDecimalComma(std::string_view text);

// The characters that may stand between cells; ' ' is any run of blanks and tabs.
inline constexpr char kSeparators[] = {',', ';', '\t', ' '};

const char* NameOf(char separator);

struct Line {
  std::string_view text;
  size_t number = 0;  // from 1
  bool comment = false;
};

using Lines = std::vector<Line>;

// The lines that are not blank, each without its end (WithoutEnd() of csv_cells.h): at most `most`, after
// those that are skipped.
Lines LinesOf(std::string_view text, char separator, size_t skip, size_t most);

std::vector<std::string_view> CellsOf(const Line& line, char separator);

// Whether every cell is empty or a number, with a point or a comma, and at least one is a number.
bool AllNumbers(const std::vector<std::string_view>& cells);

// The cell without its brackets, spelled as in base/units if the unit is known there: "[°/s]" is "deg/s",
// "PSI" is "psi", "U/min" is "rpm". Other texts come back unchanged.
std::string UnitOfCell(std::string_view cell);

// Whether the cell is a unit: one of base/units, another that recorders write (A, %, °C), or any text in
// brackets.
bool IsUnitCell(std::string_view cell);

}  // namespace hydro::tables
