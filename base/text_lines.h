// Splits text into lines.
#pragma once

#include <string>
#include <vector>

namespace hydro {

// The lines without their ends; a line end at the end of the text begins no further line.
std::vector<std::string> TextLines(const std::string& text);

// The text without blanks, tabs and carriage returns at both ends.
std::string Trimmed(const std::string& text);

}  // namespace hydro
