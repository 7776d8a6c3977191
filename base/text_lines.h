// Text as lines.
#pragma once

#include <string>
#include <vector>

namespace hydro {

// Without their ends; an end at the end of the text begins no line.
std::vector<std::string> TextLines(const std::string& text);

// Without blanks, tabs and carriage returns at both ends.
std::string Trimmed(const std::string& text);

}  // namespace hydro
