// The cells of a line of CSV.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hydro::tables {

// Without blanks and carriage returns at both ends.
std::string_view Trimmed(std::string_view text);

// Without the byte order mark of UTF-8.
std::string_view WithoutByteOrderMark(std::string_view text);

// A line without its end. Tabs at its ends are cells where tabs separate them.
std::string_view WithoutEnd(std::string_view line, char separator);

// Where the next line of a text ends: at its line feed, or at the end of the text. A line feed in a quoted cell is a
// part of it (RFC 4180); a quote that is not closed within a few lines is an ordinary character.
size_t EndOfLine(std::string_view text);

// Splits a line at each separator, or at runs of blanks and tabs where that is ' '. Quoted cells may contain
// it, and lose their quotes unless there are more in them, which CellText() resolves; an unclosed quote is an
// ordinary character.
void SplitCells(std::string_view line, char separator, std::vector<std::string_view>& cells);

// What a cell says: in a quoted one, two quotes are one (RFC 4180).
std::string CellText(std::string_view cell);

// A number with a decimal comma, and neither a point nor a second comma: "0,5".
std::optional<double> ParseDecimalComma(std::string_view text);

}  // namespace hydro::tables
