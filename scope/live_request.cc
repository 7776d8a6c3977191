#include "scope/live_request.h"

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>

#include "base/input_error.h"
#include "base/json_text.h"
#include "base/text_file.h"

namespace hydro::scope {
namespace {

using nlohmann::json;

constexpr size_t kMostText = 300;
constexpr size_t kMostEntries = 200;

InputError Wrong(const std::string& key, const json& found, const std::string& allowed) {
  const std::string text = found.is_string() ? found.get<std::string>() : JsonText(found);
  return InputError(key + ": found " + Quoted(text) + ", allowed is " + allowed);
}

// The fields of a request. Only known fields are read.
class Fields {
 public:
  explicit Fields(const json& object) : object_(object) {}

  double Number(const char* key) const {
    const auto field = object_.find(key);
    if (field == object_.end()) throw InputError(std::string(key) + ": found nothing, allowed is a number");
    if (!field->is_number() || !std::isfinite(field->get<double>())) throw Wrong(key, *field, "a number");
    return field->get<double>();
  }
  double Number(const char* key, double otherwise) const {
    return object_.contains(key) ? Number(key) : otherwise;
  }
  uint32_t Whole(const char* key, uint32_t otherwise) const {
    const double value = Number(key, otherwise);
    if (value < 0 || value > 4294967295.0 || value != std::floor(value)) {
      throw Wrong(key, object_[key], "a whole number from 0 to 4294967295");
    }
    return static_cast<uint32_t>(value);
  }
  bool Flag(const char* key, bool otherwise) const {
    const auto field = object_.find(key);
    if (field == object_.end()) return otherwise;
    if (!field->is_boolean()) throw Wrong(key, *field, "true or false");
    return field->get<bool>();
  }
  std::string Text(const char* key, const std::string& otherwise) const {
    const auto field = object_.find(key);
    if (field == object_.end()) return otherwise;
    if (!field->is_string() || field->get_ref<const std::string&>().size() > kMostText) {
      throw Wrong(key, *field, "a text of up to 300 bytes");
    }
    return field->get<std::string>();
  }
  std::vector<std::string> Texts(const char* key) const {
    const auto field = object_.find(key);
    std::vector<std::string> texts;
    if (field == object_.end()) return texts;
    if (!field->is_array() || field->size() > kMostEntries) throw Wrong(key, *field, "a list of texts");
    texts.reserve(field->size());
    for (const json& item : *field) {
      if (!item.is_string() || item.get_ref<const std::string&>().size() > kMostText) {
        throw Wrong(key, item, "a text of up to 300 bytes");
      }
      texts.push_back(item.get<std::string>());
    }
    return texts;
  }
  template <class Value>
  Value Choice(const char* key, const std::map<std::string, Value>& choices, Value otherwise) const {
    if (!object_.contains(key)) return otherwise;
    const auto choice = choices.find(Text(key, ""));
    if (choice != choices.end()) return choice->second;
    std::vector<std::string> names;
    names.reserve(choices.size());
    for (const auto& [name, value] : choices) names.push_back(name);
    throw Wrong(key, object_[key], QuotedList(names));
  }

 private:
  const json& object_;
};

const std::map<std::string, LiveRequest::Op>& Operations() {
  using Op = LiveRequest::Op;
  static const std::map<std::string, Op> operations{{"view", Op::kView},
                                                    {"unview", Op::kUnview},
                                                    {"get", Op::kGet},
                                                    {"values", Op::kValues},
                                                    {"trigger", Op::kTrigger},
                                                    {"untrigger", Op::kUntrigger},
                                                    {"arm", Op::kArm},
                                                    {"mark", Op::kMark},
                                                    {"ghost", Op::kGhost},
                                                    {"ghost_sync", Op::kGhostSync},
                                                    {"stop", Op::kStop},
                                                    {"rearm", Op::kRearm},
                                                    {"set", Op::kSet},
                                                    {"undo", Op::kUndo},
                                                    {"rearm_forecast", Op::kRearmForecast}};
  return operations;
}

TriggerRequest ReadTrigger(const Fields& fields, const LiveRequest& request) {
  TriggerRequest trigger;
  trigger.id = request.id;
  trigger.run = request.run;
  trigger.channels = request.view.channels;
  trigger.channel = fields.Text("channel", "");
  trigger.level = fields.Number("level", 0);
  using Edge = TriggerRequest::Edge;
  trigger.edge = fields.Choice<Edge>(
      "edge", {{"rising", Edge::kRising}, {"falling", Edge::kFalling}, {"either", Edge::kEither}},
      Edge::kRising);
  trigger.hysteresis = fields.Number("hysteresis", 0);
  trigger.holdoff = fields.Number("holdoff", 0);
  trigger.pre = fields.Number("pre", 0.25);
  using Mode = TriggerRequest::Mode;
  trigger.mode = fields.Choice<Mode>(
      "mode", {{"auto", Mode::kAuto}, {"normal", Mode::kNormal}, {"single", Mode::kSingle}}, Mode::kNormal);
  using On = TriggerRequest::On;
  trigger.on = fields.Choice<On>("on", {{"level", On::kLevel}, {"fault", On::kFault}, {"step", On::kStep}},
                                 On::kLevel);
  trigger.span = fields.Number("span", 1);
  trigger.pixels = request.view.pixels;
  return trigger;
}

}  // namespace

LiveRequest ParseLiveRequest(std::string_view message, uint32_t* id) {
  const json object = json::parse(message, nullptr, false);
  if (!object.is_object()) {
    throw InputError("found " + Quoted(message.substr(0, 100)) + ", allowed is a JSON object {\"op\": ...}");
  }
  const Fields fields(object);
  LiveRequest request;
  request.id = *id = fields.Whole("id", 0);
  request.op = fields.Choice<LiveRequest::Op>("op", Operations(), LiveRequest::Op::kView);
  if (!object.contains("op")) throw InputError("op: found nothing, allowed is the name of an operation");
  request.run = fields.Whole("run", 0);
  request.view.id = request.id;
  request.view.run = request.run;
  request.view.channels = fields.Texts("channels");
  request.view.pixels = fields.Whole("pixels", 1000);
  using Op = LiveRequest::Op;
  switch (request.op) {
    case Op::kView:
      request.view.span = fields.Number("span");
      request.view.fps = fields.Number("fps", 60);
      break;
    case Op::kGet:
      request.t0 = fields.Number("t0");
      request.t1 = fields.Number("t1");
      break;
    case Op::kTrigger:
      request.trigger = ReadTrigger(fields, request);
      break;
    case Op::kGhost:
      request.on = fields.Flag("on", true);
      request.resync_s = fields.Number("resync_s", 0.5);
      break;
    case Op::kMark:
      request.text = fields.Text("text", "");
      [[fallthrough]];
    case Op::kValues:
      request.t = fields.Number("t");
      break;
    case Op::kSet:
      request.entries = fields.Texts("entries");
      break;
    default:
      break;
  }
  return request;
}

}  // namespace hydro::scope
