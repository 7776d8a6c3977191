#include <sys/stat.h>

#include <string>
#include <vector>

#include "bus/seal/bus_key.h"
#include "bus/udpm/udpm_url.h"
#include "settings/model_file.h"
#include "settings/overrides.h"
#include "settings/stack_config.h"
#include "settings/toml/toml_document.h"
#include "settings/urls.h"
#include "tests/fuzz/promise.h"
#include "tests/fuzz/scratch_folder.h"
#include "tests/fuzz/targets.h"
#include "tests/settings/small_texts.h"

namespace hydro::fuzz {
namespace {

settings::StackConfig Parse(const std::string& text) {
  return settings::ParseStackConfig(text, "stack.toml", settings::kModelText, "model.toml");
}

// An accepted configuration can be run: numbers that others divide by are above zero, and its text reads back
// the same.
void Check(const settings::StackConfig& config) {
  Promise(config.position_interval_ticks >= 1 && config.pressure_interval_ticks >= 1, "intervals are ticks");
  Promise(config.plant.rate_hz > 0, "the plant ticks");
  Promise(config.last_tick == -1 || config.last_tick >= 1, "a run has an end or none");
  Promise(settings::WhatIsWrongWithBusUrl(config.bus.url).empty(), "the url is an url");
  Promise(Parse(config.text).text == config.text, "the effective text describes itself");
  const auto trajectory = settings::MakeTrajectory(config.reference.trajectory);
  for (const double time : {0.0, 0.1, 1.0, 1e6}) trajectory->Value(time);
}

}  // namespace

void StackToml(const uint8_t* data, size_t size) {
  Accepts([&] { Check(Parse(std::string(Text(data, size)))); });
}

void ModelToml(const uint8_t* data, size_t size) {
  Accepts([&] {
    const model::ModelDescription model = settings::ParseModel(std::string(Text(data, size)), "model.toml");
    const std::string text = settings::FormatModel(model);
    Promise(settings::FormatModel(settings::ParseModel(text, "model.toml")) == text,
            "a model can be written and read again");
  });
}

// One override a line.
void Overrides(const uint8_t* data, size_t size) {
  std::vector<std::string> overrides(1);
  for (const char c : Text(data, size)) {
    c == '\n' ? static_cast<void>(overrides.emplace_back()) : overrides.back().push_back(c);
  }
  if (overrides.size() > 20) return;
  Accepts([&] {
    settings::TomlNode root = settings::ParseToml(settings::kConfigText, "stack.toml");
    settings::ApplyOverrides(overrides, &root);
    Check(Parse(settings::FormatToml(root)));
  });
}

void Url(const uint8_t* data, size_t size) {
  const std::string text(Text(data, size));
  bus::UdpmUrl url;
  const bool accepted = Accepts([&] { url = bus::ParseUdpmUrl(text); });
  if (settings::WhatIsWrongWithBusUrl(text).empty())
    Promise(accepted, "what the settings allow the bus takes");
  if (!accepted) return;
  Promise(url.port > 0 && url.ttl >= 0 && url.ttl <= 255, "port and ttl are in range");
  Promise(bus::ParseUdpmUrl(url.ToString()).ToString() == url.ToString(),
          "an url can be written and read again");
}

void Key(const uint8_t* data, size_t size) {
  static const ScratchFolder folder;
  const std::string file = folder.Write("key", Text(data, size));
  chmod(file.c_str(), 0600);
  Accepts([&] { bus::ReadBusKey(file); });
}

}  // namespace hydro::fuzz
