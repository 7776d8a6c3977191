#include "batch/study/value.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "base/json_text.h"
#include "base/number_text.h"
#include "base/random.h"
#include "model/terms/description.h"
#include "model/terms/parameter_info.h"

namespace hydro::batch {
namespace {

using Kind = settings::TomlNode::Kind;

// Writes the number with a fraction, so that TOML reads it back as a float.
std::string FloatText(double value) {
  std::string text = ShortestNumber(value);
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

// The random key for a draw and a key of the study. `attempt` numbers independent ones.
uint64_t KeyOf(const Draw& draw, int64_t seed, int64_t number, uint64_t attempt = 0) {
  const uint64_t numbered = Scatter(Scatter(static_cast<uint64_t>(seed)) ^ static_cast<uint64_t>(number));
  return Scatter(Scatter(numbered ^ NameKey(draw.key)) ^ attempt);
}

double Unit(const Draw& draw, int64_t seed, int64_t number) {
  return static_cast<double>(KeyOf(draw, seed, number) >> 11) * 0x1p-53;
}

double Normal(const Draw& draw, int64_t seed, int64_t number) {
  // Reading a study refuses bounds that leave little room, so this ends.
  for (uint64_t attempt = 0; attempt < 10000; ++attempt) {
    const double deviations = StandardNormal(KeyOf(draw, seed, number, attempt));
    const double value = Rounded(draw.mean + draw.standard_deviation * deviations);
    if (value >= draw.min && value <= draw.max) return value;
  }
  return std::clamp(draw.mean, draw.min, draw.max);
}

double Uncertain(const Draw& draw, int64_t seed, int64_t number) {
  const std::string name = ParseKey(draw.key).parameter;
  const size_t base = model::BasePlace(name);
  model::ModelDescription model;
  model::BaseValue(model.parameters, base) = draw.mean;
  model.uncertainty[name] = draw.standard_deviation;
  model::Deviate(&model, base,
                 model::DrawnDeviation(static_cast<uint64_t>(seed), static_cast<uint64_t>(number), name));
  return Rounded(model::BaseValue(model.parameters, base));
}

}  // namespace

std::string TomlText(const Value& value) {
  if (const auto* number = std::get_if<double>(&value)) return FloatText(*number);
  if (const auto* text = std::get_if<std::string>(&value)) return settings::TomlString(*text);
  return PlainText(value);
}

std::string JsonText(const Value& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return JsonString(*text);
  if (const auto* number = std::get_if<double>(&value)) return FloatText(*number);
  return PlainText(value);
}

std::string PlainText(const Value& value) {
  if (const auto* number = std::get_if<double>(&value)) return ShortestNumber(*number);
  if (const auto* whole = std::get_if<int64_t>(&value)) return std::to_string(*whole);
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  return std::get<std::string>(value);
}

std::optional<double> AsNumber(const Value& value) {
  if (const auto* number = std::get_if<double>(&value)) return *number;
  if (const auto* whole = std::get_if<int64_t>(&value)) return static_cast<double>(*whole);
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? 1 : 0;
  return std::nullopt;
}

std::optional<Value> ValueOf(const settings::TomlNode& node) {
  switch (node.kind) {
    case Kind::kFloat:
      // No result can hold a number that is not finite, because JSON has none.
      return std::isfinite(node.number) ? std::optional<Value>(node.number) : std::nullopt;
    case Kind::kInteger:
      return node.integer;
    case Kind::kBoolean:
      return node.boolean;
    case Kind::kString:
      return node.text;
    default:
      return std::nullopt;
  }
}

Value ValueOfCell(const std::string& cell) {
  if (cell == "true") return true;
  if (cell == "false") return false;
  if (const auto whole = ParseInteger(cell)) return *whole;
  if (const auto number = ParseNumber(cell); number && std::isfinite(*number)) return *number;
  return cell;
}

std::string JsonString(const std::string& text) { return hydro::JsonText(nlohmann::json(text)); }

double Rounded(double value) { return ParseNumber(ShortNumber(value, 12)).value_or(value); }

double Between(double from, double to, double part, bool logarithmic) {
  const double span = logarithmic ? std::log(to / from) : to - from;
  double value = logarithmic ? from * std::exp(part * span) : from + part * span;
  if (!std::isfinite(span)) {
    value = logarithmic ? std::exp(std::lerp(std::log(from), std::log(to), part)) : std::lerp(from, to, part);
  }
  const auto [low, high] = std::minmax(from, to);
  return std::clamp(value, low, high);
}

Value DrawnValue(const Draw& draw, int64_t seed, int64_t number) {
  switch (draw.distribution) {
    case Distribution::kNormal:
      return Normal(draw, seed, number);
    case Distribution::kUncertainty:
      return Uncertain(draw, seed, number);
    case Distribution::kChoice: {
      const double place = Unit(draw, seed, number) * static_cast<double>(draw.choices.size());
      return draw.choices[std::min(static_cast<size_t>(place), draw.choices.size() - 1)];
    }
    case Distribution::kUniform:
    case Distribution::kLogUniform:
      break;
  }
  const double u = Unit(draw, seed, number);
  if (draw.whole) {
    const double value = std::floor(draw.min + u * (draw.max - draw.min + 1));
    return static_cast<int64_t>(std::min(value, draw.max));
  }
  const bool logarithmic = draw.distribution == Distribution::kLogUniform;
  return std::clamp(Rounded(Between(draw.min, draw.max, u, logarithmic)), draw.min, draw.max);
}

}  // namespace hydro::batch
