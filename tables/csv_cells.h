// The cells of a line of CSV.
#pragma once

#include <optional>
#include <string_view>
#include <vector>

namespace hydro::tables {

// Without blanks and carriage returns at both ends.
std::string_view Trimmed(std::string_view text);

// Without the byte order mark of UTF-8.
std::string_view WithoutByteOrderMark(std::string_view text);

// A line without its end. Tabs at its ends are cells where tabs separate them.
std::string_view WithoutEnd(std::string_view line, char separator);

// Splits a line at each separator, or at runs of blanks and tabs where that is ' '. Quoted cells may contain
// it, and lose their quotes; an unclosed quote is an ordinary character.
void SplitCells(std::string_view line, char separator, std::vector<std::string_view>& cells);

// A number with a decimal comma, and neither a point nor a second comma: "0,5".
std::optional<double> ParseDecimalComma(std::string_view text);

}  // namespace hydro::tables
