#include "scope/foxglove_conversation.h"

#include <cstring>
#include <hydro/messages.hpp>
#include <nlohmann/json.hpp>
#include <utility>

#include "base/json_text.h"
#include "base/text_file.h"
#include "bus/definitions/encoded_values.h"
#include "bus/definitions/message_definition.h"
#include "bus/definitions/ros_message.h"
#include "bus/messages.h"
#include "runs/exports/sheet_units.h"
#include "settings/command_line.h"

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

using nlohmann::json;

constexpr size_t kMostSubscriptions = 64;
constexpr size_t kMostReplies = 16;
constexpr char kMessageData = 1;  // the opcode

std::string Reply(const json& object) { return JsonText(object); }

template <class T>
void Put(std::string& bytes, T value) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);  // little endian, like every number here
  bytes.append(raw, sizeof value);
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

bool FoxgloveConversation::Speaks(const std::string& subprotocol) {
  return subprotocol == "foxglove.websocket.v1" || subprotocol == "foxglove.sdk.v1";
}

FoxgloveConversation::FoxgloveConversation(RunTable* runs) : runs_(*runs) {
  json channels = json::array();
  const bool live = runs_.live() != nullptr;
  const UnitSystem units = live && runs_.live()->listened != nullptr
                               ? runs_.live()->listened->model.description.units
                               : UnitSystem{};
  for (size_t i = 0; live && i < FoxgloveTopics().size(); ++i) {
    const FoxgloveTopic& topic = FoxgloveTopics()[i];
    channels.push_back({{"id", i + 1},
                        {"topic", topic.topic},
                        {"encoding", "cdr"},
                        {"schemaName", topic.schema_name},
                        {"schemaEncoding", "ros2msg"},
                        {"schema", topic.SchemaIn(units)}});
  }
  replies_.push_back(Reply({{"op", "serverInfo"},
                            {"name", "hydro-scope " + settings::ProgramVersion()},
                            {"capabilities", json::array()},
                            {"supportedEncodings", json::array()},
                            {"metadata", json::object()},
                            {"sessionId", live ? std::to_string(runs_.live()->session) : "log"}}));
  replies_.push_back(Reply({{"op", "advertise"}, {"channels", channels}}));
}

void FoxgloveConversation::Complain(const std::string& text) {
  ++wrong_;
  if (replies_.size() < kMostReplies)
    replies_.push_back(Reply({{"op", "status"}, {"level", 2}, {"message", text}}));
}

void FoxgloveConversation::Hear(std::string_view message, bool binary) {
  if (binary) return Complain("this server is read-only: nothing can be published or called here");
  Subscribe(message);
}

void FoxgloveConversation::Subscribe(std::string_view message) {
  const json object = json::parse(message, nullptr, false);
  if (!object.is_object() || !object.contains("op") || !object["op"].is_string()) {
    return Complain("found no JSON object with an \"op\"");
  }
  const std::string op = object["op"];
  const auto list = object.find(op == "subscribe" ? "subscriptions" : "subscriptionIds");
  if (op != "subscribe" && op != "unsubscribe")
    return Complain("\"" + Printable(op.substr(0, 40)) + "\": this server is read-only");
  if (list == object.end() || !list->is_array()) return Complain(op + ": found no list");
  for (const json& item : *list) {
    if (op == "unsubscribe") {
      if (!item.is_number_unsigned())
        return Complain("unsubscribe: found " + JsonText(item) + ", allowed are ids");
      for (auto& [channel, ids] : subscriptions_) ids.erase(item.get<uint32_t>());
      continue;
    }
    const auto number = [&](const char* key) -> uint64_t {
      const auto field = item.is_object() ? item.find(key) : item.end();
      return item.is_object() && field != item.end() && field->is_number_unsigned() ? field->get<uint64_t>()
                                                                                    : UINT64_MAX;
    };
    const uint64_t id = number("id");
    const uint64_t channel = number("channelId");
    if (id > UINT32_MAX || channel < 1 || channel > FoxgloveTopics().size() || runs_.live() == nullptr) {
      return Complain("subscribe: allowed are the channels that were advertised");
    }
    const FoxgloveTopic& topic = FoxgloveTopics()[channel - 1];
    auto& ids = subscriptions_[topic.channel + runs_.live()->suffix];
    if (ids.size() >= kMostSubscriptions) return Complain("subscribe: allowed are 64 of a channel");
    ids[static_cast<uint32_t>(id)] = channel - 1;
  }
}

bool FoxgloveConversation::Next(Message* message) {
  if (!replies_.empty()) {
    *message = {std::move(replies_.front()), false};
    replies_.pop_front();
    return true;
  }
  if (ready_.empty() && runs_.live() != nullptr) {
    const MessageStore& store = *runs_.live()->messages;
    if (store_ != &store) place_ = store.End();  // the store of another run
    store_ = &store;
    skipped_ += store.CatchUp(&place_, kMostBehind);
    for (MessageStore::Message found; ready_.empty() && store.Read(&place_, &found);) {
      const auto ids = subscriptions_.find(found.channel);
      if (ids == subscriptions_.end() || ids->second.empty()) continue;
      const FoxgloveTopic& topic = FoxgloveTopics()[ids->second.begin()->second];
      if (!topic.Encode(found.data, static_cast<int>(found.size), &cdr_)) continue;
      for (const auto& [id, topic_index] : ids->second) {
        std::string bytes(1, kMessageData);
        Put(bytes, id);
        Put(bytes, static_cast<uint64_t>(found.utime) * 1000);
        bytes += cdr_;
        ready_.push_back({std::move(bytes), true});
      }
    }
  }
  if (ready_.empty()) return false;
  *message = std::move(ready_.front());
  ready_.pop_front();
  return true;
}

}  // namespace hydro::scope
