#include "batch/study/value.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "base/json_text.h"
#include "base/number_text.h"

namespace hydro::batch {
namespace {

using Kind = settings::TomlNode::Kind;

// Writes the number with a fraction, so that TOML reads it back as a float.
std::string FloatText(double value) {
  std::string text = ShortestNumber(value);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

}  // namespace

std::string TomlText(const Value& value) {
  if (const auto* number = std::get_if<double>(&value)) return FloatText(*number);
  if (const auto* text = std::get_if<std::string>(&value)) return settings::TomlString(*text);
  return PlainText(value);
}

std::string JsonText(const Value& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return JsonString(*text);
  if (const auto* number = std::get_if<double>(&value)) return FloatText(*number);
  return PlainText(value);
}

std::string PlainText(const Value& value) {
  if (const auto* number = std::get_if<double>(&value)) return ShortestNumber(*number);
  if (const auto* whole = std::get_if<int64_t>(&value)) return std::to_string(*whole);
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  return std::get<std::string>(value);
}

std::optional<double> AsNumber(const Value& value) {
  if (const auto* number = std::get_if<double>(&value)) return *number;
  if (const auto* whole = std::get_if<int64_t>(&value)) return static_cast<double>(*whole);
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? 1 : 0;
  return std::nullopt;
}

std::optional<Value> ValueOf(const settings::TomlNode& node) {
  switch (node.kind) {
    case Kind::kFloat:
      // No result can hold a number that is not finite, because JSON has none.
      return std::isfinite(node.number) ? std::optional<Value>(node.number) : std::nullopt;
    case Kind::kInteger:
      return node.integer;
    case Kind::kBoolean:
      return node.boolean;
    case Kind::kString:
      return node.text;
    default:
      return std::nullopt;
  }
}

Value ValueOfCell(const std::string& cell) {
  if (cell == "true") return true;
  if (cell == "false") return false;
  if (const auto whole = ParseInteger(cell)) return *whole;
  if (const auto number = ParseNumber(cell); number && std::isfinite(*number)) return *number;
  return cell;
}

std::string JsonString(const std::string& text) { return hydro::JsonText(nlohmann::json(text)); }

}  // namespace hydro::batch
