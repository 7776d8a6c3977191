// The values of a message out of its encoding, field by field.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

#include "bus/definitions/message_definition.h"

namespace hydro::definitions {

// Whole numbers and truth values, numbers, texts, and lists of them.
using Value = std::variant<int64_t, double, std::string, std::vector<int64_t>, std::vector<double>,
                           std::vector<std::string>>;

// The values of an encoded message, in the order of the definition's fields, with or without a seal after it. False: the
// bytes are no whole message of that type and version; `values` is then anything.
bool ReadValues(const MessageDefinition& definition, const uint8_t* data, int size,
                std::vector<Value>* values);

}  // namespace hydro::definitions
