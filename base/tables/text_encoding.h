// Texts of other programs in UTF-8.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "base/input_error.h"

namespace hydro::tables {

// The text in UTF-8 where its byte order mark says that it is UTF-16; empty for any other text, which is
// taken as it is. Throws InputError for a text with zero bytes and no such mark, and for half a character
// at the end of UTF-16; `file` is for messages. What is no character becomes U+FFFD.
std::optional<std::string> FromUtf16(std::string_view text, const std::string& file);

// Where the text is not UTF-8: "found byte 0xb0, which is not UTF-8, allowed UTF-8: save the table as UTF-8 (...)"; empty where
// all of it is.
std::string NotUtf8(std::string_view text);

}  // namespace hydro::tables
