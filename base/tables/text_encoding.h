// Converts texts of other programs to UTF-8.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/input_error.h"

namespace hydro::tables {

// The text in UTF-8 if its byte order mark marks it as UTF-16; empty for any other text, which is used
// unchanged. Throws InputError for a text with zero bytes and no such mark, and for half a character at the
// end of UTF-16; `file` is for messages. Invalid characters become U+FFFD.
std::optional<std::string> FromUtf16(std::string_view text, const std::string& file);

// The text with line feeds in place of carriage returns if those alone end its lines; else empty.
std::optional<std::string> FromCarriageReturns(std::string_view text);

// For a text that is not UTF-8: "found byte 0xb0, which is not UTF-8, allowed UTF-8: save the table as UTF-8
// (...)"; empty when all of it is UTF-8.
std::string NotUtf8(std::string_view text);

}  // namespace hydro::tables
