#include "batch/run/case_result.h"

#include <nlohmann/json.hpp>

namespace hydro::batch {
namespace {

std::optional<Value> FromJson(const nlohmann::json& value) {
  if (value.is_boolean()) return value.get<bool>();
  if (value.is_number_integer()) return value.get<int64_t>();
  if (value.is_number()) return value.get<double>();
  if (value.is_string()) return value.get<std::string>();
  return std::nullopt;
}

}  // namespace

std::string ResultText(const Study& study, int64_t index, const CaseResult& result) {
  std::string text = "{\n  \"case\": " + std::to_string(index) +
                     ",\n  \"status\": " + (result.failed ? "\"failed\"" : "\"done\"") +
                     ",\n  \"attempts\": " + std::to_string(result.attempts) + ",\n  \"values\": {";
  const std::vector<std::string> keys = study.Keys();
  const std::vector<Value> values = study.Values(index);
  for (size_t i = 0; i < keys.size(); ++i)
    text += (i == 0 ? "" : ", ") + JsonString(keys[i]) + ": " + JsonText(values[i]);
  text += "},\n";
  if (result.failed) return text + "  \"reason\": " + JsonString(result.reason) + "\n}\n";
  text += "  \"numbers\": {";
  for (size_t i = 0; i < study.collect.size(); ++i) {
    text += (i == 0 ? "" : ", ") + JsonString(study.collect[i].name) + ": " +
            (result.numbers[i] ? JsonText(*result.numbers[i]) : "null");
  }
  return text + "}\n}\n";
}

std::optional<CaseResult> ParseResult(const Study& study, int64_t index, const std::string& text) {
  const nlohmann::json json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object() || json.value("case", int64_t{-1}) != index) return std::nullopt;
  CaseResult result;
  result.failed = json.value("status", "") == "failed";
  result.attempts = json.value("attempts", 0);
  result.reason = json.value("reason", "");
  const auto numbers = json.find("numbers");
  for (const Collected& each : study.collect) {
    const bool known = numbers != json.end() && numbers->contains(each.name);
    result.numbers.push_back(known ? FromJson((*numbers)[each.name]) : std::nullopt);
  }
  return result;
}

}  // namespace hydro::batch
