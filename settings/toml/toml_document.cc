#include "settings/toml/toml_document.h"

#include <toml++/toml.h>

#include <algorithm>
#include <optional>
#include <sstream>

#include "base/file_kind.h"
#include "base/number_text.h"
#include "base/text_file.h"
#include "settings/toml/defined_twice.h"

namespace hydro::settings {
namespace {

constexpr int kMostKeyParts = 16;  // keys of this project have up to three parts
constexpr int kMostBrackets = 16;  // one inside another; values of this project have two

// Bounds the depth of a document before it is parsed. toml++ bounds the nesting of arrays and inline tables,
// but builds a table inside a table for each part of a dotted key, and a key of a hundred thousand parts
// exhausts the stack. A document that passes is at most kMostKeyParts * (kMostBrackets + 1) + kMostBrackets
// levels deep. The scan recognises strings and comments as toml++ does and nothing else: toml++ reports text
// that is not TOML.
class DepthScan {
 public:
  explicit DepthScan(std::string_view text) : text_(text) {}

  // The first place that is too deep, as "LINE: syntax: found ..., allowed ..."; empty: there is none.
  std::string FirstTooDeep() {
    int parts = 1;
    int brackets = 0;
    while (at_ < text_.size()) {
      const char c = text_[at_];
      if (c == '"' || c == '\'') {
        SkipString(c);
        continue;
      }
      if (c == '#') {
        at_ = std::min(text_.find('\n', at_), text_.size());
        continue;
      }
      if (c == '.') {
        if (++parts > kMostKeyParts) return TooDeep("a key", "parts (a.b.c has three)", kMostKeyParts);
      } else if (c == '\n' || c == '=' || c == ',' || c == '{' || c == '[' || c == ']') {
        parts = 1;
      }
      if (c == '[' || c == '{') {
        if (++brackets > kMostBrackets) return TooDeep("a value", "brackets in brackets", kMostBrackets);
      } else if (c == ']' || c == '}') {
        brackets = std::max(brackets - 1, 0);
      }
      Step(1);
    }
    return {};
  }

 private:
  std::string TooDeep(const std::string& what, const std::string& of, int most) const {
    return std::to_string(line_) + ": syntax: found " + what + " of more than " + std::to_string(most) + " " +
           of + ", allowed " + std::to_string(most);
  }

  bool At(std::string_view what) const { return text_.substr(at_, what.size()) == what; }

  void Step(size_t count) {
    for (; count > 0 && at_ < text_.size(); --count, ++at_) line_ += text_[at_] == '\n' ? 1 : 0;
  }

  void SkipString(char quote) {
    const std::string thrice(3, quote);
    const std::string end = At(thrice) ? thrice : std::string(1, quote);
    Step(end.size());
    while (at_ < text_.size() && !At(end)) {
      if (end.size() == 1 && text_[at_] == '\n') return;  // not TOML
      Step(quote == '"' && text_[at_] == '\\' ? 2 : 1);
    }
    Step(end.size());
    // Up to two quotes directly before the closing three belong to the string: """a""""" holds a"".
    for (int extra = 0; end.size() == 3 && extra < 2 && At(std::string_view(&quote, 1)); ++extra) Step(1);
  }

  std::string_view text_;
  size_t at_ = 0;
  int line_ = 1;
};

TomlNode Convert(const toml::node& from, const std::string& name) {
  TomlNode node;
  node.place = name + ":" + std::to_string(from.source().begin.line);
  if (const toml::table* table = from.as_table()) {
    node.kind = TomlNode::Kind::kTable;
    // toml++ sorts by name, but people, and the order of effects in a model, follow the file.
    std::vector<std::pair<const toml::key*, const toml::node*>> entries;
    for (auto&& [key, value] : *table) entries.emplace_back(&key, &value);
    std::stable_sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) {
      const toml::source_position& x = a.first->source().begin;
      const toml::source_position& y = b.first->source().begin;
      return x.line != y.line ? x.line < y.line : x.column < y.column;
    });
    for (const auto& [key, value] : entries) {
      node.members.push_back({std::string(key->str()), Convert(*value, name)});
      node.members.back().second.place = name + ":" + std::to_string(key->source().begin.line);
    }
  } else if (const toml::array* array = from.as_array()) {
    node.kind = TomlNode::Kind::kArray;
    for (const toml::node& item : *array) node.items.push_back(Convert(item, name));
  } else if (const auto* string = from.as_string()) {
    node.kind = TomlNode::Kind::kString;
    node.text = string->get();
  } else if (const auto* integer = from.as_integer()) {
    node.kind = TomlNode::Kind::kInteger;
    node.integer = integer->get();
  } else if (const auto* number = from.as_floating_point()) {
    node.kind = TomlNode::Kind::kFloat;
    node.number = number->get();
  } else if (const auto* boolean = from.as_boolean()) {
    node.kind = TomlNode::Kind::kBoolean;
    node.boolean = boolean->get();
  } else {
    node.kind = TomlNode::Kind::kDate;
    std::ostringstream text;
    from.visit([&text](const auto& value) { text << value; });
    node.text = text.str();
  }
  return node;
}

// Refuses files that are not settings text at all, whatever the first byte is that TOML does not allow.
void RefuseOtherKinds(const std::string& text, const std::string& name) {
  const std::optional<FileKind> kind = FindFileKind(std::string_view(text).substr(0, 64));
  if (!kind.has_value() || *kind >= FileKind::kStack) return;
  throw InputError(name + ": " + OtherKind(*kind, name, "a TOML file"));
}

// Whether each of the first two lines has cells, and both have the same number, as in a table.
bool LooksLikeTable(const std::string& text) {
  const size_t end = text.find('\n');
  if (end == std::string::npos) return false;
  const size_t next = std::min(text.find('\n', end + 1), text.size());
  const auto count = [&](size_t from, size_t to, char separator) {
    return std::count(text.begin() + static_cast<std::ptrdiff_t>(from),
                      text.begin() + static_cast<std::ptrdiff_t>(to), separator);
  };
  if (count(0, end, '=') > 0) return false;
  for (const char separator : {',', ';', '\t'}) {
    const auto cells = count(0, end, separator);
    if (cells > 0 && cells == count(end + 1, next, separator)) return true;
  }
  return false;
}

}  // namespace

const TomlNode* TomlNode::Find(const std::string& key) const {
  for (const auto& member : members) {
    if (member.first == key) return &member.second;
  }
  return nullptr;
}

TomlNode* TomlNode::Find(const std::string& key) {
  return const_cast<TomlNode*>(std::as_const(*this).Find(key));
}

void TomlNode::Erase(const std::string& key) {
  std::erase_if(members, [&key](const auto& member) { return member.first == key; });
}

std::string TomlNode::Shown() const {
  switch (kind) {
    case Kind::kTable:
      return "a section";
    case Kind::kArray:
      return items.empty() ? "an empty array" : "an array";
    case Kind::kString:
      return Quoted(text);
    case Kind::kInteger:
      return std::to_string(integer);
    case Kind::kFloat:
      return ShortestNumber(number);
    case Kind::kBoolean:
      return boolean ? "true" : "false";
    case Kind::kDate:
      break;
  }
  return "a date or time";
}

TomlNode NumberNode(double value) {
  TomlNode node;
  node.kind = TomlNode::Kind::kFloat;
  node.number = value;
  return node;
}

TomlNode StringNode(std::string text) {
  TomlNode node;
  node.kind = TomlNode::Kind::kString;
  node.text = std::move(text);
  return node;
}

TomlNode ArrayNode(std::vector<TomlNode> items) {
  TomlNode node;
  node.kind = TomlNode::Kind::kArray;
  node.items = std::move(items);
  return node;
}

TomlNode ParseToml(const std::string& text, const std::string& name) {
  RefuseOtherKinds(text, name);
  if (const std::string place = DepthScan(text).FirstTooDeep(); !place.empty()) {
    throw InputError(name + ":" + place);
  }
  try {
    return Convert(toml::parse(text, name), name);
  } catch (const toml::parse_error& error) {
    RefuseSingleBrackets(text, name, error.source().begin.line);
    if (LooksLikeTable(text)) {
      throw InputError(
          name +
          ":1: syntax: found a table, allowed a TOML file; hydro-diagnose reads it with a sidecar beside it, "
          "hydro-log import makes a log of export's columns");
    }
    std::string description(error.description());
    if (description.find("cannot redefine existing") != std::string::npos)
      RefuseSecondDefinition(text, name, error.source().begin.line);
    std::replace_if(
        description.begin(), description.end(), [](unsigned char c) { return c < 0x20; }, ' ');
    throw InputError(name + ":" + std::to_string(error.source().begin.line) + ": syntax: " + description);
  }
}

}  // namespace hydro::settings
