// docs/messages.md, written from the table of messages (bus/messages.h) and the comments of the .lcm files.
#pragma once

#include <string>
#include <vector>

namespace hydro::bus {

// What an .lcm file says about its type.
struct LcmField {
  std::string type;     // e.g. double, int64_t[buckets]; const int8_t for a constant
  std::string name;     // with its value for a constant: LAW = 0
  std::string unit;     // the text in brackets before the comment; empty: none
  std::string meaning;  // the rest of the comment
  bool constant = false;
};
struct LcmStruct {
  std::string name;
  std::string comment;  // the comment before the struct, on one line
  std::vector<LcmField> fields;
};

// Reads the text of an .lcm file with one struct. Throws InputError naming `file` and the line for anything
// it cannot read, for a field without a comment and for a double without a unit.
LcmStruct ParseLcm(const std::string& text, const std::string& file);

// The whole page. `folder` must hold an .lcm file for each message, or InputError is thrown.
std::string MessagesPage(const std::string& folder);

}  // namespace hydro::bus
