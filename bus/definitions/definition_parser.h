// Reads the text of a message definition in the part of LCM's language that ours use.
#pragma once

#include <string>
#include <string_view>

#include "bus/definitions/message_definition.h"

namespace hydro::definitions {

// Reads one struct of plain fields, lists whose length is an earlier field, and constants. The comment at a
// line's end belongs to its field, and continues in lines that hold nothing but a comment. `channel` and
// `hash` are left empty. Throws InputError that names `file` and the line: a struct within another, a list of
// fixed length and a list of lists are not allowed.
MessageDefinition ParseDefinition(std::string_view text, const std::string& file);

}  // namespace hydro::definitions
