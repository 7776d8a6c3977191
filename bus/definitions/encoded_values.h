// Reads the values of a message from its encoding, field by field.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "bus/definitions/message_definition.h"

namespace hydro::definitions {

// Integers and booleans, floating-point numbers, texts, and lists of them.
using Value = std::variant<int64_t, double, std::string, std::vector<int64_t>, std::vector<double>,
                           std::vector<std::string>>;

// Reads the values of an encoded message, in the order of the definition's fields, with or without a seal
// after it. Returns false when the bytes are not a whole message of that type and version; `values` is then
// unspecified.
bool ReadValues(const MessageDefinition& definition, const uint8_t* data, int size,
                std::vector<Value>* values);

}  // namespace hydro::definitions
