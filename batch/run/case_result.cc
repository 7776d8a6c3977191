#include "batch/run/case_result.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>

#include "base/text_file.h"
#include "batch/store/small_file.h"
#include "settings/toml/toml_document.h"

namespace hydro::batch {
namespace {

std::optional<Value> FromJson(const nlohmann::json& value) {
  if (value.is_boolean()) return value.get<bool>();
  if (value.is_number_integer()) return value.get<int64_t>();
  if (value.is_number()) return value.get<double>();
  if (value.is_string()) return value.get<std::string>();
  return std::nullopt;
}

using nlohmann::json;
using Kind = settings::TomlNode::Kind;

json FromToml(const settings::TomlNode& node) {
  switch (node.kind) {
    case Kind::kTable: {
      json table = json::object();
      for (const auto& [key, value] : node.members) table[key] = FromToml(value);
      return table;
    }
    case Kind::kArray: {
      json array = json::array();
      for (const settings::TomlNode& item : node.items) array.push_back(FromToml(item));
      return array;
    }
    case Kind::kInteger:
      return node.integer;
    case Kind::kFloat:
      return node.number;
    case Kind::kBoolean:
      return node.boolean;
    case Kind::kString:
    case Kind::kDate:
      break;
  }
  return node.text;
}

std::string Listed(std::vector<std::string> names) {
  constexpr size_t kMost = 20;
  if (names.size() > kMost) {
    names.resize(kMost);
    names.emplace_back("...");
  }
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string FilesIn(const std::string& folder) {
  std::vector<std::string> names;
  std::error_code failed;
  for (const auto& entry : std::filesystem::directory_iterator(folder, failed))
    if (entry.path().filename() != "inputs") names.push_back(entry.path().filename());
  std::ranges::sort(names);
  return Listed(names);
}

// Says how far a pointer leads into a document, and what is there.
std::string NothingThere(const json& document, const Collected& from) {
  json::json_pointer deepest;
  try {
    deepest = json::json_pointer(from.pointer);
    while (!deepest.empty() && !document.contains(deepest)) deepest = deepest.parent_pointer();
  } catch (const json::exception&) {  // it is not a pointer
    deepest = json::json_pointer();
  }
  const json& there = document.at(deepest);
  std::string has = "a value";
  if (there.is_array()) has = "a list of " + std::to_string(there.size());
  if (there.is_object()) {
    std::vector<std::string> keys;
    for (const auto& item : there.items()) keys.push_back(item.key());
    has = "only " + Listed(keys);
  }
  return from.file + ":" + from.pointer + ": found nothing there; " +
         (deepest.empty() ? "the file" : deepest.to_string()) + " has " + has;
}

json ReadDocument(const std::string& folder, const std::string& file) {
  const auto text = ReadSmallFile(folder + "/" + file);
  if (!text) throw InputError(file + ": not written by any step; there are " + FilesIn(folder));
  if (file.ends_with(".toml")) return FromToml(settings::ParseToml(*text, file));
  json document = json::parse(*text, nullptr, false);
  if (document.is_discarded())
    throw InputError(file + ": found no JSON in it, allowed JSON, or TOML in a file .toml");
  return document;
}

std::optional<Value> Scalar(const json& value, const Collected& from) {
  if (value.is_null()) return std::nullopt;
  if (value.is_boolean()) return value.get<bool>();
  if (value.is_number_integer()) return value.get<int64_t>();
  if (value.is_number() && std::isfinite(value.get<double>())) return value.get<double>();
  if (value.is_string()) return value.get<std::string>();
  throw InputError(from.file + ":" + from.pointer + ": found " + std::string(value.type_name()) +
                   ", allowed a number, true, false, text or null");
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

std::vector<std::optional<Value>> CollectNumbers(const Study& study, const std::string& folder,
                                                 const std::vector<int>& exit_codes) {
  std::map<std::string, json> documents = {{"exit_codes.json", exit_codes}};
  std::vector<std::optional<Value>> numbers;
  for (const Collected& each : study.collect) {
    auto document = documents.find(each.file);
    if (document == documents.end())
      document = documents.emplace(each.file, ReadDocument(folder, each.file)).first;
    const json* found = nullptr;
    try {
      found = &document->second.at(json::json_pointer(each.pointer));
    } catch (const json::exception&) {
      throw InputError(NothingThere(document->second, each));
    }
    numbers.push_back(Scalar(*found, each));
  }
  return numbers;
}

}  // namespace hydro::batch
