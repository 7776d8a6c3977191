// The values of a case, and the keys and draws from which they come.
#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "settings/toml/toml_document.h"

namespace hydro::batch {

// A value that a case has for a key, or a number that it leaves.
using Value = std::variant<double, int64_t, bool, std::string>;

// The value as TOML and as JSON; the text of a number reads back as the same number.
std::string TomlText(const Value& value);
std::string JsonText(const Value& value);
// The value without quotes, for a table or a command.
std::string PlainText(const Value& value);

// The value as a number for a picture; none for text.
std::optional<double> AsNumber(const Value& value);

// None for a table, an array or a date.
std::optional<Value> ValueOf(const settings::TomlNode& node);

// Reads a cell of a CSV file: a whole number, a number, true, false, or else text.
Value ValueOfCell(const std::string& cell);

// `text` in JSON's quotes. Bytes that are not UTF-8 are replaced.
std::string JsonString(const std::string& text);

// The keys that a study may vary: "position.c2" of the configuration, "model:b" of the model's parameters,
// "effect:pump.stribeck.static_excess" of its effects, "machine:b" and "machine:pump.stribeck.static_excess"
// of the simulated machine alone, which the controllers do not know, and the study's own names without a
// point ("trial"), for commands.
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

// Random values of cases. A case's values depend only on the study's seed, the case's number and the key, and
// not on other keys, other cases, their order, or the machine.

// kUncertainty: a parameter of the model, varied by the uncertainty with which its value is known
// (model/terms/description.h).
enum class Distribution { kUniform, kLogUniform, kNormal, kChoice, kUncertainty };

struct Draw {
  std::string key;
  Distribution distribution = Distribution::kUniform;
  double min = -std::numeric_limits<double>::infinity();  // kNormal: values beyond the bounds are drawn again
  double max = std::numeric_limits<double>::infinity();
  double mean = 0;                  // kNormal; kUncertainty: the model's value
  double standard_deviation = 0;    // kNormal; kUncertainty: relative
  bool whole = false;               // kUniform: whole numbers from min to max, both included
  std::vector<Value> choices = {};  // kChoice
};

// The value of draw `number`. For the key model:NAME with kUncertainty, this is the value that
// model::DrawnModel() gives that parameter.
Value DrawnValue(const Draw& draw, int64_t seed, int64_t number);

// Rounds to twelve significant digits, because the last bits of exp and log differ between machines. A value
// that is not finite stays unchanged.
double Rounded(double value);

// The value at the fraction `part`, 0 to 1, of the way from one to the other, evenly or by equal factors
// (both above 0). It is finite and between them for any two finite numbers, even where their difference or
// ratio is not finite.
double Between(double from, double to, double part, bool logarithmic);

}  // namespace hydro::batch
