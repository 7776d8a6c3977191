// The keys that a study may vary: "position.c2" of the configuration, "model:b" of the model's parameters,
// "effect:pump.stribeck.static_excess" of its effects, "machine:b" and "machine:pump.stribeck.static_excess"
// of the simulated machine alone, which the controllers do not know, and the study's own names without a
// point ("trial"), for commands.
#pragma once

#include <string>

namespace hydro::batch {

enum class KeyKind { kOwn, kConfiguration, kModel, kEffect, kMachine };

struct Key {
  KeyKind kind = KeyKind::kOwn;
  std::string effect;     // kEffect, kMachine: its id; empty: the parameter belongs to the model
  std::string parameter;  // kModel, kEffect, kMachine; otherwise the whole text
};

inline Key ParseKey(const std::string& text) {
  if (text.starts_with("model:")) return {KeyKind::kModel, "", text.substr(6)};
  const bool machine = text.starts_with("machine:");
  if (machine || text.starts_with("effect:")) {
    const KeyKind kind = machine ? KeyKind::kMachine : KeyKind::kEffect;
    const std::string path = text.substr(text.find(':') + 1);
    const size_t point = path.rfind('.');
    if (point == std::string::npos) return {kind, "", path};
    return {kind, path.substr(0, point), path.substr(point + 1)};
  }
  return {text.find('.') == std::string::npos ? KeyKind::kOwn : KeyKind::kConfiguration, "", text};
}

}  // namespace hydro::batch
