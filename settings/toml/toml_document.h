// A TOML document as a tree that keeps the order of its keys and each one's place.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/input_error.h"

namespace hydro::settings {

struct TomlMember;

struct TomlNode {
  enum class Kind { kTable, kArray, kString, kInteger, kFloat, kBoolean, kDate };
  Kind kind = Kind::kTable;
  std::vector<TomlMember> members;  // kTable, in the document's order
  std::vector<TomlNode> items;      // kArray
  std::string text;                 // kString; kDate, as TOML
  int64_t integer = 0;              // kInteger
  double number = 0;                // kFloat
  bool boolean = false;             // kBoolean
  std::string place;                // "file:line", or the option that set it
  bool from_option = false;         // true: from --set
  std::string former = {};          // the key's name before its present name replaced it (quantity_keys.h)

  bool is(Kind k) const { return kind == k; }
  bool is_number() const { return kind == Kind::kInteger || kind == Kind::kFloat; }
  double AsDouble() const { return kind == Kind::kInteger ? static_cast<double>(integer) : number; }

  const TomlNode* Find(const std::string& key) const;  // null when there is none
  TomlNode* Find(const std::string& key);
  void Erase(const std::string& key);

  // What was found, for a message: a value as it would be written, or the kind of a table or array.
  std::string Shown() const;
};

struct TomlMember {
  std::string first;  // the key
  TomlNode second;
};

TomlNode NumberNode(double value);
TomlNode StringNode(std::string text);
TomlNode ArrayNode(std::vector<TomlNode> items);

// The only reader of TOML, for trusted and untrusted text alike: no text can exhaust the stack. Throws
// InputError "name:line: syntax: ..." when the text is not TOML or nests deeper than any document of this
// project.
TomlNode ParseToml(const std::string& text, const std::string& name);

// TOML text that ParseToml reads back as the same tree, doubles bit by bit.
std::string FormatToml(const TomlNode& table);

// `text` as a TOML string on one line.
std::string TomlString(const std::string& text);

}  // namespace hydro::settings
