// Reads whole text files, and shows what was found in them.
#pragma once

#include <string>
#include <string_view>

#include "base/input_error.h"

namespace hydro {

// The file's bytes. Throws InputError "file: ..." when it cannot be read or is larger than 64 MiB.
std::string ReadTextFile(const std::string& file);

// Throws InputError for a folder, a pipe or a device.
void CheckIsFile(const std::string& file);

// Throws InputError for a device: /dev/zero has no end, and a terminal waits for somebody who types.
void CheckIsNoDevice(const std::string& file);

// The path of `file`, which is absolute or relative to the folder of `beside`.
std::string PathBeside(const std::string& beside, const std::string& file);

// `text` in double quotes on one line, with control characters escaped and the middle of long texts omitted.
std::string Quoted(std::string_view text);

// `text` made safe for a terminal: tabs and valid UTF-8 stay. Anything that could move the cursor, change
// colours or break the line (control characters, and bytes that are not UTF-8, which 8-bit terminals take for
// control characters) becomes "\\x1b".
std::string Printable(std::string_view text);

// Makes the text printable line by line: its own line ends stay.
std::string PrintableLines(std::string_view text);

// "\"a\", \"b\" or \"c\""; for a very long list, the first names and the number of the others.
template <class Names>
std::string QuotedList(const Names& names) {
  constexpr size_t kMost = 100;
  std::string list;
  size_t i = 0;
  for (const auto& name : names) {
    if (i == kMost) return list + ", ... (" + std::to_string(std::size(names) - kMost) + " more)";
    if (i > 0) list += i + 1 == std::size(names) ? " or " : ", ";
    list += Quoted(name);
    ++i;
  }
  return list;
}

}  // namespace hydro
