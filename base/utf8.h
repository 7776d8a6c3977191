// The door for text from outside: messages, logs, files, what other programs print, names of files. It may
// hold any bytes; what is shown, and every file and message that promises UTF-8, holds only text that has
// come through here or through JsonText() (base/json_text.h).
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace hydro {

// How many bytes the UTF-8 character at the start of `text` takes (1 to 4); 0: there is none, because the
// text is empty or cut, or because the bytes are a surrogate (U+D800 to U+DFFF), an overlong form, or beyond
// U+10FFFF.
size_t CharacterLength(std::string_view text);

bool IsUtf8(std::string_view text);

// `text` with each byte that is part of no character written as "\\xed". UTF-8 stays as it is, control
// characters too.
std::string AsUtf8(std::string_view text);

// The beginning of `text`, at most `most` bytes of it, that does not end within a character.
std::string_view FirstBytes(std::string_view text, size_t most);

}  // namespace hydro
