#include "scope/live_tuning.h"

#include <nlohmann/json.hpp>
#include <utility>

#include "base/input_error.h"
#include "base/json_text.h"
#include "base/number_text.h"
#include "base/text_file.h"
#include "runs/recorded/tuning_history.h"
#include "tune/live/rearm_forecast.h"
#include "tune/live/saved_config.h"
#include "tune/live/tunable_keys.h"

namespace hydro::scope {
namespace {

using OrderedJson = nlohmann::ordered_json;

OrderedJson ValueOf(const std::string& toml) {
  if (const auto number = ParseNumber(toml)) return *number;
  return toml;
}

}  // namespace

LiveTuning::LiveTuning(bus::Bus& bus, const bus::Clock& clock, const bus::Channels& channels, uint32_t run,
                       bool control)
    : client_(bus, clock, channels, "hydro-scope"), run_(run), control_(control) {}

bool LiveTuning::Ready(const Done& done) {
  if (!client_.in_force() || !client_.run()) {
    done({false,
          "no running stack has said which values are in force (one with a key is heard with that key alone: "
          "bus.key_file)",
          {}});
  } else if (client_.asking()) {
    done({false, "another change is under way, try again", {}});
  } else {
    return true;
  }
  return false;
}

void LiveTuning::Set(const std::vector<std::string>& entries, Done done) {
  if (!Ready(done)) return;
  std::string changes;
  for (const std::string& entry : entries) changes += (changes.empty() ? "" : "\n") + entry;
  waiting_ = std::move(done);
  client_.Set(changes);
}

void LiveTuning::Undo(Done done) {
  if (!Ready(done)) return;
  waiting_ = std::move(done);
  client_.Undo();
}

void LiveTuning::Poll() {
  client_.Poll();
  if (const auto answer = client_.TakeAnswer(); answer && waiting_) {
    OrderedJson data;
    if (answer->accepted) {
      const double rate_hz = client_.run()->rate_hz;
      data = {
          {"tick", answer->acts_at},
          {"t", rate_hz > 0 ? OrderedJson(static_cast<double>(answer->acts_at) / rate_hz) : OrderedJson()},
          {"version", answer->version}};
    }
    std::exchange(waiting_, nullptr)(
        {answer->accepted != 0, PrintableLines(answer->text), data.is_null() ? "" : JsonText(data)});
  }
  const auto& in_force = client_.in_force();
  if (!in_force || !client_.run() || client_.run()->session != in_force->session) return;
  if (session_ == in_force->session && version_ == in_force->version) return;
  session_ = in_force->session;
  version_ = in_force->version;
  Describe();
}

void LiveTuning::Describe() {
  const tuned_settings_t& in_force = *client_.in_force();
  OrderedJson entries = OrderedJson::array();
  try {
    const auto values = tuning::ValuesInForce(*client_.run(), in_force, NumberText);
    const settings::StackConfig config = tuning::ConfigInForce(*client_.run(), in_force);
    for (const tuning::TunableKey& row : tuning::TunableKeys()) {
      const auto value = values.find(std::string(row.key));
      if (value == values.end()) continue;
      entries.push_back({{"key", row.key},
                         {"value", ValueOf(value->second)},
                         {"unit", tuning::UnitOf(row, config)},
                         {"range", row.range},
                         {"what", row.what},
                         {"acts_in", row.acts_in}});
    }
  } catch (const InputError&) {
    // The stack has another version: there is nothing to show, and its plant refuses this version's requests.
  }
  const std::string text = in_force.version > 0 ? Printable(runs::DescribeInForce(in_force)) : std::string();
  message_ = JsonText(OrderedJson({{"op", "tuning"},
                                   {"run", run_},
                                   {"control", control_},
                                   {"version", in_force.version},
                                   {"acts_at", in_force.acts_at},
                                   {"text", text},
                                   {"entries", entries}}));
}

}  // namespace hydro::scope
