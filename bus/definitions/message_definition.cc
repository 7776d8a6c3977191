#include "bus/definitions/message_definition.h"

#include <stdexcept>

#include "bus/definitions/definition_parser.h"
#include "bus/definitions/definition_texts.h"
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

}  // namespace hydro::definitions
