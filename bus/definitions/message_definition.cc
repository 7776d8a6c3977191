#include "bus/definitions/message_definition.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <regex>
#include <stdexcept>

#include "base/input_error.h"
#include "base/text_file.h"
#include "base/word_list.h"
#include "bus/messages.h"

namespace hydro::definitions {

bool IsWhole(FieldType type) {
  return type != FieldType::kFloat && type != FieldType::kDouble && type != FieldType::kString;
}

int SizeOf(FieldType type) {
  switch (type) {
    case FieldType::kBoolean:
    case FieldType::kByte:
    case FieldType::kInt8:
      return 1;
    case FieldType::kInt16:
      return 2;
    case FieldType::kInt32:
    case FieldType::kFloat:
      return 4;
    case FieldType::kInt64:
    case FieldType::kDouble:
      return 8;
    case FieldType::kString:
      break;
  }
  return 0;
}

const std::vector<MessageDefinition>& Definitions() {
  static const std::vector<MessageDefinition> definitions = [] {
    std::vector<MessageDefinition> all;
    all.reserve(bus::kMessageCount);
    bus::ForEachMessage([&]<class Message>(const bus::MessageRow<Message>& row) {
      const std::string type = Message::getTypeName();
      for (const DefinitionText& text : DefinitionTexts()) {
        if (text.file != "hydro_" + type + ".lcm") continue;
        all.push_back(ParseDefinition(text.text, std::string(text.file)));
        all.back().channel = row.channel;
        all.back().hash = Message::getHash();
        return;
      }
      throw std::logic_error("lcmtypes/hydro_" + type + ".lcm is not among the definitions of this program");
    });
    return all;
  }();
  return definitions;
}

const MessageDefinition* DefinitionOf(std::string_view channel) {
  for (const MessageDefinition& definition : Definitions()) {
    if (channel.starts_with(definition.channel)) return &definition;
  }
  return nullptr;
}

namespace {

constexpr struct {
  std::string_view name;
  FieldType type;
} kTypes[] = {
    {"boolean", FieldType::kBoolean}, {"byte", FieldType::kByte},     {"int8_t", FieldType::kInt8},
    {"int16_t", FieldType::kInt16},   {"int32_t", FieldType::kInt32}, {"int64_t", FieldType::kInt64},
    {"float", FieldType::kFloat},     {"double", FieldType::kDouble}, {"string", FieldType::kString}};

std::optional<FieldType> TypeNamed(const std::string& name) {
  const auto* const found =
      std::find_if(std::begin(kTypes), std::end(kTypes), [&](const auto& one) { return one.name == name; });
  return found == std::end(kTypes) ? std::nullopt : std::optional(found->type);
}

class Parser {
 public:
  explicit Parser(const std::string& file) : file_(file) {}

  void Take(const std::string& line) {
    ++line_;
    const size_t slashes = line.find("//");
    const std::string code = Trimmed(line.substr(0, slashes));
    const std::string comment = slashes == std::string::npos ? "" : Trimmed(line.substr(slashes + 2));
    if (!code.empty()) {
      TakeCode(code, comment);
    } else if (slashes != std::string::npos) {
      GoOn(comment);
    } else {
      comment_of_ = nullptr;
    }
  }

  MessageDefinition Finish() {
    if (!closed_) throw Error("the end of the text", "a struct that ends with }");
    for (Field& field : definition_.fields) SplitUnit(&field);
    return std::move(definition_);
  }

 private:
  InputError Error(const std::string& found, const std::string& allowed) const {
    return InputError(file_ + ": line " + std::to_string(line_) + ": found " + found + ", allowed " +
                      allowed);
  }

  // Adds a line with nothing but a comment: to the struct's comment when the struct has not begun, otherwise
  // to that of the field before it.
  void GoOn(const std::string& comment) {
    std::string* const text = definition_.type.empty() ? &definition_.description : comment_of_;
    if (text != nullptr) *text += (text->empty() ? "" : " ") + comment;
  }

  void TakeCode(const std::string& code, const std::string& comment) {
    static const std::regex package(R"(package\s+\w+\s*;)"), begin(R"(struct\s+(\w+)\s*\{?)"),
        field(R"((\w+)\s+(\w+)\s*(?:\[\s*([A-Za-z_]\w*)\s*\])?\s*;)"),
        constant(R"(const\s+(\w+)\s+(\w+)\s*=\s*([^;]+?)\s*;)");
    std::smatch match;
    comment_of_ = nullptr;
    if (std::regex_match(code, package) || (code == "{" && !definition_.type.empty())) return;
    if (std::regex_match(code, match, begin) && definition_.type.empty()) {
      definition_.type = match[1];
    } else if (code == "}" && !definition_.type.empty()) {
      closed_ = true;
    } else if (definition_.type.empty() || closed_) {
      throw Error(Quoted(code), "one struct");
    } else if (std::regex_match(code, match, constant)) {
      definition_.constants.push_back({match[2], KnownType(match[1]), match[3], comment});
      comment_of_ = &definition_.constants.back().description;
    } else if (std::regex_match(code, match, field)) {
      if (match[3].length() > 0) CheckCount(match[3]);
      definition_.fields.push_back({match[2], KnownType(match[1]), match[3], "", comment});
      comment_of_ = &definition_.fields.back().description;
    } else {
      throw Error(Quoted(code), "\"TYPE NAME;\", \"TYPE NAME[COUNT];\" or \"const TYPE NAME = VALUE;\"");
    }
  }

  FieldType KnownType(const std::string& name) const {
    if (const std::optional<FieldType> type = TypeNamed(name)) return *type;
    std::vector<std::string> names;
    for (const auto& type : kTypes) names.emplace_back(type.name);
    throw Error("the type " + Quoted(name), QuotedList(names));
  }

  void CheckCount(const std::string& name) const {
    const auto& fields = definition_.fields;
    if (std::any_of(fields.begin(), fields.end(), [&](const Field& field) {
          return field.name == name && !field.is_list() && IsWhole(field.type);
        })) {
      return;
    }
    throw Error("the length " + Quoted(name), "a whole number among the fields before it");
  }

  // Takes the unit out of "[psi] pressure of side 1"; "[as value] ..." names the field that holds the unit.
  static void SplitUnit(Field* field) {
    std::string& text = field->description;
    const size_t end = text.find(']');
    if (!text.starts_with("[") || end == std::string::npos) return;
    const std::string unit = text.substr(1, end - 1);
    if (unit.starts_with("as ")) return;
    field->unit = unit;
    text = Trimmed(text.substr(end + 1));
  }

  std::string file_;
  int line_ = 0;
  MessageDefinition definition_;
  std::string* comment_of_ = nullptr;
  bool closed_ = false;
};

}  // namespace

MessageDefinition ParseDefinition(std::string_view text, const std::string& file) {
  Parser parser(file);
  for (const std::string& line : TextLines(std::string(text))) parser.Take(line);
  return parser.Finish();
}

}  // namespace hydro::definitions
