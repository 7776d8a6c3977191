// A value that a case has for a key, or a number that it leaves.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <variant>

#include "settings/toml/toml_document.h"

namespace hydro::batch {

using Value = std::variant<double, int64_t, bool, std::string>;

// The value as TOML and as JSON; the text of a number reads back as the same number.
std::string TomlText(const Value& value);
std::string JsonText(const Value& value);
// The value without quotes, for a table or a command.
std::string PlainText(const Value& value);

// The value as a number for a picture; none for text.
std::optional<double> AsNumber(const Value& value);

// None for a table, an array or a date.
std::optional<Value> ValueOf(const settings::TomlNode& node);

// Reads a cell of a CSV file: a whole number, a number, true, false, or else text.
Value ValueOfCell(const std::string& cell);

// `text` in JSON's quotes. Bytes that are not UTF-8 are replaced.
std::string JsonString(const std::string& text);

}  // namespace hydro::batch
