// The entry for all text from outside: messages, logs, files, other programs' output, file names. Such text
// may hold any bytes; displays, and every file and message that promises UTF-8, hold only text that has come
// through here or through JsonText() (base/json_text.h).
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace hydro {

// The number of bytes (1 to 4) of the UTF-8 character at the start of `text`. 0 when there is none, because
// the text is empty or cut, or because the bytes are a surrogate (U+D800 to U+DFFF), an overlong form, or
// beyond U+10FFFF.
size_t CharacterLength(std::string_view text);

bool IsUtf8(std::string_view text);

// `text` with each byte that is not part of a character written as "\\xed". UTF-8 stays as it is, including
// control characters.
std::string AsUtf8(std::string_view text);

// The beginning of `text`, at most `most` bytes, which does not end within a character.
std::string_view FirstBytes(std::string_view text, size_t most);

}  // namespace hydro
