// Reads the text of a message definition in LCM's language, as far as ours use it.
#pragma once

#include <string>
#include <string_view>

#include "bus/definitions/message_definition.h"

namespace hydro::definitions {

// One struct of plain fields, lists whose length is a field before them, and constants; the comment at a line's end belongs to its
// field, and goes on in lines that have nothing else. `channel` and `hash` are left empty. Throws InputError that names `file` and the
// line: a struct within another, a list of fixed length and a list of lists are not allowed.
MessageDefinition ParseDefinition(std::string_view text, const std::string& file);

}  // namespace hydro::definitions
