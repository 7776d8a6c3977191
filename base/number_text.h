// Numbers as text that does not depend on the locale and gives the same bits back.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace hydro {

// Appends the shortest text that reads back as the same number ("nan", "inf" and "-inf" for those).
void AppendNumber(double value, std::string& text);
std::string NumberText(double value);

// Reads a whole text as a number; decimal, "inf" and "nan" in any case, a leading '+'. Empty: it is not a
// number, or is outside the range of a double.
std::optional<double> ParseNumber(std::string_view text);
std::optional<int64_t> ParseInteger(std::string_view text);

}  // namespace hydro
