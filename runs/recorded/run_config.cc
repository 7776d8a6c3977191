#include "runs/recorded/run_config.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "base/input_error.h"
#include "base/integers.h"
#include "base/maths/spread.h"
#include "settings/model_file.h"
#include "settings/toml/toml_document.h"
#include "settings/toml/toml_edit.h"

namespace hydro::runs {
namespace {

using settings::TomlNode;

// A log is untrusted input, so its text goes through the only reader of TOML.
TomlNode Parse(const std::string& text, const std::string& file, const std::string& what) {
  try {
    return settings::ParseToml(text, file + ": run description: " + what);
  } catch (const InputError& error) {
    throw InputError(std::string(error.what()) +
                     "; the log's own description of its run (HYDRO_RUN) is damaged: hydro-log info, and "
                     "export --channel HYDRO_STATE, do without it");
  }
}

constexpr char kLimb[] = "hydro-limb";

bool IsOfALimb(const RunMessages& messages) {
  const auto& descriptions = messages.Of<run_description_t>();
  return std::any_of(descriptions.begin(), descriptions.end(),
                     [](const run_description_t& run) { return run.program == kLimb; });
}

}  // namespace

std::vector<std::pair<std::string, std::string>> ConfigEntries(const run_description_t& description,
                                                               const std::string& file) {
  TomlNode root = Parse(description.config_text, file, "configuration");
  // For a limb, also the joints' own sections, by name.
  std::vector<settings::TomlEntry> entries;
  if (const TomlNode* joints = root.Find("joint"); joints != nullptr && joints->is(TomlNode::Kind::kArray)) {
    for (const TomlNode& joint : joints->items) {
      const TomlNode* name = joint.is(TomlNode::Kind::kTable) ? joint.Find("name") : nullptr;
      const std::string shown = name != nullptr ? name->text : "?";
      for (auto& [key, value] : settings::TomlEntries(joint))
        entries.emplace_back("joint." + shown + "." + key, value);
    }
    root.Erase("joint");
  }
  for (auto& entry : settings::TomlEntries(root)) entries.push_back(std::move(entry));
  std::sort(entries.begin(), entries.end());
  return entries;
}

int CommandDelayTicks(const run_description_t& description, const std::string& file) {
  const TomlNode config = Parse(description.config_text, file, "configuration");
  const TomlNode* plant = config.Find("plant");
  const TomlNode* delay = plant == nullptr ? nullptr : plant->Find("command_delay_ticks");
  if (delay == nullptr) return 1;
  if (!delay->is_number() || (delay->AsDouble() != 0 && delay->AsDouble() != 1)) {
    throw InputError(delay->place + ": plant.command_delay_ticks: found " + delay->Shown() +
                     ", allowed 0 or 1");
  }
  return static_cast<int>(delay->AsDouble());
}

std::string ModelName(const run_description_t& description, const std::string& file) {
  const TomlNode model = Parse(description.model_text, file, "model");
  const TomlNode* name = model.Find("name");
  return name != nullptr && name->is(TomlNode::Kind::kString) ? name->text : std::string();
}

void RequireReadable(const run_description_t& description, const std::string& file) {
  Parse(description.config_text, file, "configuration");
  Parse(description.model_text, file, "model");
}

UnitSystem ModelUnits(const run_description_t& description, const std::string& file) {
  try {
    return settings::ParseModelUnits(description.model_text, file + " (model)");
  } catch (const InputError&) {
    Parse(description.model_text, file, "model");  // says so where the text is damaged
    throw;
  }
}

// A limb numbers only the states that it sends, so those that it left out do not count as lost.
int64_t SampleTicks(const RunMessages& messages) {
  if (!IsOfALimb(messages)) return 1;
  const auto& states = messages.Of<state_t>();
  std::vector<int64_t> steps, left_out;
  for (size_t i = 1; i < states.size(); ++i) {
    if (states[i].sequence != SaturatingSum(states[i - 1].sequence, 1)) continue;
    steps.push_back(SaturatingDifference(states[i].tick, states[i - 1].tick));
    const int64_t skipped = SaturatingSum(1, std::max<int64_t>(0, states[i].skipped_ticks));
    left_out.push_back(SaturatingDifference(steps.back(), skipped));
  }
  return steps.empty() || maths::Median(left_out) <= 0 ? 1 : maths::Median(steps);
}

std::string DescribeSampling(int64_t sample_ticks) {
  if (sample_ticks <= 1) return {};
  return "a state every " + std::to_string(sample_ticks) + " ticks (limb.telemetry_hz)";
}

void RequireEveryState(const RunLog& log, const std::string& needs_it) {
  const int64_t sampled = SampleTicks(log.messages);
  if (sampled <= 1) return;
  throw InputError(log.file + (log.joint.empty() ? "" : ": joint " + log.joint) + ": found " +
                   DescribeSampling(sampled) + ", allowed is each for " + needs_it +
                   ": record with limb.telemetry_hz = \"every_tick\", in lockstep, or with hydro-sim");
}

}  // namespace hydro::runs
