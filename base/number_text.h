// Numbers as text and back, independent of the locale. There are three ways to write a number, by purpose:
// exact in files, exact in messages, rounded in reports.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace hydro {

// For files that programs read: the shortest text that reads back as the same number (or "nan", "inf",
// "-inf"; 0.0002 is "2e-04").
void AppendNumber(double value, std::string& text);
std::string NumberText(double value);

// For messages and settings that people read and write: the same digits, without an exponent from 1e-4 to
// 1e15 ("0.0002").
std::string ShortestNumber(double value);

// For reports: rounded to this many significant digits, or to a whole number if that has more: 3.14, 81000,
// 2.6e-05. "-" when it is not finite.
std::string ShortNumber(double value, int digits = 4);

// A stamp in us since 1970, for people: "2026-11-26 17:33:14.123456 UTC", and as "12.5 s" what is no date of
// a recording, because a simulated clock begins at 0.
std::string StampText(int64_t utime);

// "0x001f", with at least this many digits.
std::string HexNumber(uint64_t value, int digits);

// Reads a whole text as a number: decimal, "inf" and "nan" in any case, a leading '+'. Empty when the text is
// not a number or is outside the range of a double.
std::optional<double> ParseNumber(std::string_view text);
std::optional<int64_t> ParseInteger(std::string_view text);

}  // namespace hydro
