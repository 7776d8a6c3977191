#include "batch/study/step_reader.h"

#include <optional>

namespace hydro::batch {
namespace {

using settings::SectionReader;
using settings::TomlNode;
using Kind = TomlNode::Kind;

// The command of a step that has a known name. `machine`: cases have a machine that the controllers do not
// know.
std::optional<std::vector<std::string>> NamedCommand(const std::string& name, bool machine) {
  if (name == "hydro-sim") {
    if (machine) return {{"hydro-sim", "config.toml", "--machine", "machine.toml", "-o", "run.lcmlog"}};
    return {{"hydro-sim", "config.toml", "-o", "run.lcmlog"}};
  }
  if (name == "summary") return {{"hydro-log", "summary", "run.lcmlog", "--json", "summary.json"}};
  if (name == "hydro-tune") return {{"hydro-tune", "config.toml", "-o", "tuned.toml", "--jobs", "1"}};
  return std::nullopt;
}

std::vector<int> ReadExitCodes(SectionReader* section) {
  const TomlNode* node = section->Take("exit_codes");
  if (node == nullptr) return {0};
  const std::string allowed = "a list of whole numbers from 0 to 255";
  std::vector<int> codes;
  for (const TomlNode& item : node->items) {
    const std::optional<int64_t> code = settings::WholeNumber(item);
    if (!code || *code < 0 || *code > 255) throw section->Error("exit_codes", item.Shown(), allowed);
    codes.push_back(static_cast<int>(*code));
  }
  if (codes.empty()) throw section->Error("exit_codes", node->Shown(), allowed);
  return codes;
}

Step ReadStep(SectionReader section, const std::string& place, bool machine) {
  Step step;
  step.place = place;
  step.exit_codes = ReadExitCodes(&section);
  const TomlNode* run = section.Take("run");
  section.Finish();
  if (run == nullptr) throw section.Error("run", "nothing", "a command");
  if (run->is(Kind::kString)) {
    const auto command = NamedCommand(run->text, machine);
    if (!command) {
      throw section.Error(
          "run", run->Shown(),
          "\"hydro-sim\", \"summary\", \"hydro-tune\" or a list: a program and its arguments");
    }
    step.argv = *command;
    return step;
  }
  step.argv = Texts(&section, "run");
  if (step.argv.empty()) throw section.Error("run", run->Shown(), "a program and its arguments");
  return step;
}

}  // namespace

std::vector<std::string> Texts(SectionReader* section, const std::string& key) {
  std::vector<std::string> texts;
  const TomlNode* node = section->Take(key);
  if (node == nullptr) return texts;
  const std::string allowed = "a list of texts";
  if (!node->is(Kind::kArray)) throw section->Error(key, node->Shown(), allowed);
  for (const TomlNode& item : node->items) {
    if (!item.is(Kind::kString) || item.text.empty()) throw section->Error(key, item.Shown(), allowed);
    texts.push_back(item.text);
  }
  return texts;
}

std::vector<Step> ReadSteps(SectionReader* study, bool has_config, bool has_machine) {
  const TomlNode* node = study->Take("step");
  if (node == nullptr) {
    if (!has_config) {
      throw study->Error("step", "nothing",
                         "a command, or config for hydro-sim (above the first section of the file)");
    }
    return {{.argv = *NamedCommand("hydro-sim", has_machine)}, {.argv = *NamedCommand("summary", false)}};
  }
  if (!node->is(Kind::kArray) || node->items.empty())
    throw study->Error("step", node->Shown(), "sections [[step]]");
  std::vector<Step> steps;
  for (const TomlNode& item : node->items) {
    if (!item.is(Kind::kTable)) throw study->Error("step", item.Shown(), "sections [[step]]");
    const TomlNode* run = item.Find("run");
    steps.push_back(
        ReadStep(study->Item(item, "step"), run != nullptr ? run->place : item.place, has_machine));
  }
  return steps;
}

}  // namespace hydro::batch
