#include "runs/run_config.h"

#include <toml++/toml.h>

#include <sstream>

#include "base/input_error.h"
#include "base/number_text.h"

namespace hydro::runs {
namespace {

toml::table Parse(const std::string& text, const std::string& file, const char* what) {
  try {
    return toml::parse(text);
  } catch (const toml::parse_error& error) {
    throw InputError(file + ": run description: " + what + ", line " +
                     std::to_string(error.source().begin.line) + ": " + std::string(error.description()) +
                     "; TOML is needed");
  }
}

// A value as TOML on one line; numbers in the shortest form, which toml++ does not write.
std::string ValueText(const toml::node& node) {
  if (const auto* number = node.as_floating_point()) return NumberText(number->get());
  std::string text;
  if (const toml::array* array = node.as_array()) {
    for (const toml::node& element : *array) text += (text.empty() ? "" : ", ") + ValueText(element);
    return "[" + text + "]";
  }
  if (const toml::table* table = node.as_table()) {
    for (const auto& [key, value] : *table) {
      text += (text.empty() ? "" : ", ") + std::string(key.str()) + " = " + ValueText(value);
    }
    return "{" + text + "}";
  }
  std::ostringstream stream;
  node.visit([&](const auto& value) { stream << value; });
  return stream.str();
}

void Flatten(const toml::table& table, const std::string& prefix,
             std::vector<std::pair<std::string, std::string>>& entries) {
  for (const auto& [key, node] : table) {
    const std::string name = prefix + std::string(key.str());
    if (const toml::table* inner = node.as_table()) {
      Flatten(*inner, name + ".", entries);
    } else {
      entries.emplace_back(name, ValueText(node));
    }
  }
}

}  // namespace

std::vector<std::pair<std::string, std::string>> ConfigEntries(const run_description_t& description,
                                                               const std::string& file) {
  std::vector<std::pair<std::string, std::string>> entries;
  Flatten(Parse(description.config_text, file, "configuration"), "", entries);
  return entries;
}

int CommandDelayTicks(const run_description_t& description, const std::string& file) {
  const toml::table config = Parse(description.config_text, file, "configuration");
  const auto node = config.at_path("plant.command_delay_ticks");
  if (!node) return 1;
  const std::optional<int64_t> delay = node.value<int64_t>();
  if (delay != 0 && delay != 1) {
    throw InputError(file + ": run description: plant.command_delay_ticks: found something else than 0 or 1");
  }
  return static_cast<int>(*delay);
}

std::string ModelName(const run_description_t& description, const std::string& file) {
  const toml::table model = Parse(description.model_text, file, "model");
  return model["name"].value_or(std::string());
}

}  // namespace hydro::runs
