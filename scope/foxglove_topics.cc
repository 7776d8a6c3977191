#include "scope/foxglove_topics.h"

#include <hydro/messages.hpp>

#include "bus/definitions/encoded_values.h"
#include "bus/definitions/message_definition.h"
#include "bus/definitions/ros_message.h"
#include "bus/messages.h"
#include "runs/exports/sheet_units.h"

namespace hydro::scope {
namespace {

template <bus::StackMessage Message>
FoxgloveTopic Topic() {
  const definitions::MessageDefinition& definition =
      *definitions::DefinitionOf(bus::RowOf<Message>().channel);
  FoxgloveTopic topic;
  topic.topic = definitions::RosTopic(definition.channel);
  topic.channel = definition.channel;
  topic.schema_name = definitions::RosType(definition.type);
  return topic;
}

}  // namespace

std::string FoxgloveTopic::SchemaIn(const UnitSystem& units) const {
  const definitions::MessageDefinition& definition = *definitions::DefinitionOf(channel);
  std::vector<definitions::Field> fields = definition.fields;
  for (definitions::Field& field : fields) field.unit = exports::UnitOfField(units, field);
  return definitions::RosSchema(fields, definition.constants);
}

bool FoxgloveTopic::Encode(const uint8_t* data, int size, std::string* cdr) const {
  const definitions::MessageDefinition& definition = *definitions::DefinitionOf(channel);
  thread_local std::vector<definitions::Value> values;
  if (!definitions::ReadValues(definition, data, size, &values)) return false;
  definitions::WriteCdr(definition.fields, values, cdr);
  return true;
}

const std::vector<FoxgloveTopic>& FoxgloveTopics() {
  static const std::vector<FoxgloveTopic> topics = {
      Topic<state_t>(),         Topic<motor_command_t>(), Topic<pressure_command_t>(),
      Topic<arm_reference_t>(), Topic<fault_t>(),         Topic<loop_statistics_t>()};
  return topics;
}

}  // namespace hydro::scope
