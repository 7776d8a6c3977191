// Writing TOML: plain keys first, then sections, in the tree's order.
#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>

#include "base/number_text.h"
#include "base/text_file.h"
#include "settings/toml/toml_document.h"

namespace hydro::settings {
namespace {

using Kind = TomlNode::Kind;

std::string Key(const std::string& key) {
  const bool bare = !key.empty() && std::all_of(key.begin(), key.end(), [](unsigned char c) {
    return (c < 0x80 && std::isalnum(c)) || c == '_' || c == '-';
  });
  return bare ? key : TomlString(key);
}

std::string Number(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  std::string text = ShortestNumber(value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";  // else it would be read as an integer
  return text;
}

std::string Value(const TomlNode& node) {
  std::string out;
  switch (node.kind) {
    case Kind::kTable:
      for (const auto& [key, value] : node.members) {
        out += (out.empty() ? "" : ", ") + Key(key) + " = " + Value(value);
      }
      return "{ " + out + " }";
    case Kind::kArray:
      for (const TomlNode& item : node.items) out += (out.empty() ? "" : ", ") + Value(item);
      return "[" + out + "]";
    case Kind::kString:
      return TomlString(node.text);
    case Kind::kInteger:
      return std::to_string(node.integer);
    case Kind::kFloat:
      return Number(node.number);
    case Kind::kBoolean:
      return node.boolean ? "true" : "false";
    case Kind::kDate:
      break;
  }
  return node.text;
}

bool IsArrayOfTables(const TomlNode& node) {
  return node.is(Kind::kArray) && !node.items.empty() &&
         std::all_of(node.items.begin(), node.items.end(),
                     [](const TomlNode& item) { return item.is(Kind::kTable); });
}

void Append(const TomlNode& table, const std::string& path, std::string* out) {
  for (const auto& [key, value] : table.members) {
    if (value.is(Kind::kTable) || IsArrayOfTables(value)) continue;
    *out += Key(key) + " = " + Value(value) + "\n";
  }
  for (const auto& [key, value] : table.members) {
    const std::string inner = path.empty() ? Key(key) : path + "." + Key(key);
    if (value.is(Kind::kTable)) {
      *out += (out->empty() ? "[" : "\n[") + inner + "]\n";
      Append(value, inner, out);
    } else if (IsArrayOfTables(value)) {
      for (const TomlNode& item : value.items) {
        *out += (out->empty() ? "[[" : "\n[[") + inner + "]]\n";
        Append(item, inner, out);
      }
    }
  }
}

}  // namespace

std::string TomlString(const std::string& text) {
  std::string out = "\"";
  for (const char character : text) {
    const unsigned char c = static_cast<unsigned char>(character);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += character;
    } else if (c < 0x20 || c == 0x7f) {
      char code[8];
      std::snprintf(code, sizeof code, "\\u%04X", c);
      out += code;
    } else {
      out += character;
    }
  }
  return out + "\"";
}

std::string FormatToml(const TomlNode& table) {
  std::string out;
  Append(table, "", &out);
  return out;
}

}  // namespace hydro::settings
