// What a study may vary: "position.c2" of the configuration, "model:b" of the model's parameters,
// "effect:pump.stribeck.static_excess" of its effects, and names without a point ("trial") of its own, for commands.
#pragma once

#include <string>

namespace hydro::batch {

enum class KeyKind { kOwn, kConfiguration, kModel, kEffect };

struct Key {
  KeyKind kind = KeyKind::kOwn;
  std::string effect;     // kEffect: its id
  std::string parameter;  // kModel, kEffect; else the whole text
};

inline Key ParseKey(const std::string& text) {
  if (text.starts_with("model:")) return {KeyKind::kModel, "", text.substr(6)};
  if (text.starts_with("effect:")) {
    const std::string path = text.substr(7);
    const size_t point = path.rfind('.');
    if (point == std::string::npos) return {KeyKind::kEffect, "", path};
    return {KeyKind::kEffect, path.substr(0, point), path.substr(point + 1)};
  }
  return {text.find('.') == std::string::npos ? KeyKind::kOwn : KeyKind::kConfiguration, "", text};
}

}  // namespace hydro::batch
