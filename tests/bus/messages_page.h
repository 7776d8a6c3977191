// docs/messages.md, written from the table of messages (bus/messages.h) and the comments of the .lcm files.
#pragma once

#include <string>
#include <vector>

namespace hydro::bus {

// What an .lcm file says of its type.
struct LcmField {
  std::string type;     // e.g. double, int64_t[buckets]; const int8_t for a constant
  std::string name;     // with its value for a constant: LAW = 0
  std::string unit;     // what stands in brackets before the comment; empty: none
  std::string meaning;  // the rest of the comment
  bool constant = false;
};
struct LcmStruct {
  std::string name;
  std::string comment;  // what stands before the struct, on one line
  std::vector<LcmField> fields;
};

// Reads the text of an .lcm file with one struct. Throws InputError that names `file` and the line for what
// it cannot read, for a field without a comment and for a double without a unit.
LcmStruct ParseLcm(const std::string& text, const std::string& file);

// The whole page. `folder` holds the .lcm files: one for each message, or InputError.
std::string MessagesPage(const std::string& folder);

}  // namespace hydro::bus
