#include "batch/study/case_inputs.h"

#include <algorithm>
#include <optional>
#include <set>
#include <vector>

#include "base/text_file.h"
#include "batch/study/value.h"
#include "model/terms/parameter_info.h"
#include "settings/model_file.h"
#include "settings/overrides.h"
#include "settings/stack_config.h"

namespace hydro::batch {
namespace {

void SetEffect(const Key& key, double value, model::ModelDescription* model) {
  for (model::EffectDescription& effect : model->effects) {
    if (effect.id == key.effect) {
      effect.parameters[key.parameter] = value;
      return;
    }
  }
  model->effects.push_back({key.effect, {{key.parameter, value}}, {}});
}

using settings::TomlNode;

constexpr int64_t kMostChecked = 200;
constexpr int64_t kMostDraws = 20;

// Cases that together cover every value of the grid, and the first rows and draws.
std::set<int64_t> CheckedCases(const Study& study) {
  const int64_t rows = study.list.keys.empty() ? 1 : static_cast<int64_t>(study.list.rows.size());
  std::set<int64_t> cases = {0};
  if (!study.draws.empty()) {
    for (int64_t draw = 0; draw < std::min(study.draw_count, kMostDraws); ++draw) cases.insert(draw);
  }
  for (int64_t row = 0; row < std::min(rows, kMostChecked); ++row) cases.insert(row * study.draw_count);
  int64_t stride = study.draw_count * rows;
  for (size_t i = study.grid.size(); i-- > 0;) {
    const auto count = static_cast<int64_t>(study.grid[i].values.size());
    for (int64_t k = 0; k < std::min(count, kMostChecked); ++k) cases.insert(k * stride);
    stride *= count;
  }
  return cases;
}

// What is wrong with a case; empty: nothing. Line numbers are left out, because the user has never seen the
// files that they refer to.
std::string Wrong(const Study& study, const CaseInputs& inputs, const std::vector<Value>& values) {
  try {
    const std::string model = inputs.Model(values), machine = inputs.Machine(values);
    if (!machine.empty()) settings::ParseModel(machine, "machine.toml");
    if (study.config_text.empty()) {
      settings::ParseModel(model, "model.toml");
    } else {
      settings::ParseStackConfig(inputs.Config(values), "config.toml", model, "model.toml");
    }
  } catch (const std::exception& error) {
    const std::string text = error.what();
    const bool placed = text.starts_with("config.toml:") || text.starts_with("model.toml:") ||
                        text.starts_with("machine.toml:");
    return placed ? text.substr(std::min(text.size(), text.find(": ") + 2)) : text;
  }
  return "";
}

// The key without which a case would be right; none when there is no such key.
std::optional<size_t> Culprit(const Study& study, const std::vector<std::string>& keys,
                              const std::vector<Value>& values) {
  for (size_t i = 0; i < keys.size(); ++i) {
    Study others;
    others.config_text = study.config_text;
    others.model_text = study.model_text;
    for (size_t k = 0; k < keys.size(); ++k) {
      if (k != i) others.grid.push_back({keys[k], {values[k]}});
    }
    if (Wrong(others, CaseInputs(others), others.Values(0)).empty()) return i;
  }
  return std::nullopt;
}

void CheckCase(const Study& study, const TomlNode& root, const std::string& file, const CaseInputs& inputs,
               int64_t index) {
  const std::vector<Value> values = study.Values(index);
  const std::string wrong = Wrong(study, inputs, values);
  if (wrong.empty()) return;
  const std::vector<std::string> keys = study.Keys();
  if (const auto i = Culprit(study, keys, values)) {
    const bool drawn = *i >= keys.size() - study.draws.size();
    throw InputError(PlaceOfKey(root, keys[*i]) + ": " + keys[*i] + " = " + PlainText(values[*i]) + ": " +
                     wrong + (drawn ? "; give the draw min and max" : ""));
  }
  std::string shown;
  for (size_t i = 0; i < keys.size(); ++i)
    shown += (i == 0 ? "" : ", ") + keys[i] + " = " + PlainText(values[i]);
  throw InputError(file + ": case " + std::to_string(index) + " (" + shown + "): " + wrong);
}

}  // namespace

CaseInputs::CaseInputs(const Study& study) : study_(study), keys_(study.Keys()) {
  for (const std::string& key : keys_) {
    const KeyKind kind = ParseKey(key).kind;
    config_varies_ = config_varies_ || kind == KeyKind::kConfiguration;
    model_varies_ = model_varies_ || kind == KeyKind::kModel || kind == KeyKind::kEffect;
    machine_varies_ = machine_varies_ || kind == KeyKind::kMachine;
  }
  if (!study.config_text.empty()) config_ = settings::ParseToml(study.config_text, "config.toml");
  if (!study.model_text.empty()) model_ = settings::ParseModel(study.model_text, "model.toml");
}

std::string CaseInputs::Config(const std::vector<Value>& values) const {
  if (!config_varies_) return study_.config_text;
  std::vector<std::string> overrides;
  for (size_t i = 0; i < keys_.size(); ++i) {
    if (ParseKey(keys_[i]).kind == KeyKind::kConfiguration)
      overrides.push_back(keys_[i] + "=" + TomlText(values[i]));
  }
  settings::TomlNode config = config_;
  settings::ApplyOverrides(overrides, &config);
  return settings::FormatToml(config);
}

std::string CaseInputs::Model(const std::vector<Value>& values) const {
  return model_varies_ ? settings::FormatModel(Changed(values, false)) : study_.model_text;
}

std::string CaseInputs::Machine(const std::vector<Value>& values) const {
  return machine_varies_ ? settings::FormatModel(Changed(values, true)) : "";
}

// The model with the case's values. For the machine, it also has the changes that are the machine's own.
model::ModelDescription CaseInputs::Changed(const std::vector<Value>& values, bool machine) const {
  model::ModelDescription model = model_;
  for (size_t i = 0; i < keys_.size(); ++i) {
    const Key key = ParseKey(keys_[i]);
    const bool of_model = key.kind == KeyKind::kModel || key.kind == KeyKind::kEffect;
    if (!of_model && !(machine && key.kind == KeyKind::kMachine)) continue;
    const auto number = AsNumber(values[i]);
    if (!number) {
      throw InputError(keys_[i] + ": found " + Quoted(PlainText(values[i])) + ", allowed a number");
    }
    if (!key.effect.empty()) {
      SetEffect(key, *number, &model);
    } else {
      model::BaseValue(model.parameters, model::BasePlace(key.parameter)) = *number;
    }
  }
  return model;
}

std::string PlaceOfKey(const TomlNode& root, const std::string& key, size_t which) {
  std::vector<std::string> places;
  for (const char* name : {"grid", "list", "draw"}) {
    const TomlNode* sections = root.Find(name);
    if (sections == nullptr) continue;
    const std::string all = key.substr(0, key.find(':') + 1) + "*";
    for (const TomlNode& section : sections->items) {
      const TomlNode* text = section.Find("key");
      if (text != nullptr && (text->text == key || text->text == all)) places.push_back(text->place);
    }
    const TomlNode* list = sections->Find("keys");
    if (list == nullptr) continue;
    for (const TomlNode& item : list->items) {
      if (item.text == key) places.push_back(item.place);
    }
  }
  if (which < places.size()) return places[which];
  const TomlNode* list = root.Find("list");
  return list != nullptr ? list->place : root.place;
}

void CheckConfigurations(const Study& study, const TomlNode& root, const std::string& file) {
  if (study.model_text.empty()) return;
  const CaseInputs inputs(study);
  for (const int64_t index : CheckedCases(study)) CheckCase(study, root, file, inputs, index);
}

}  // namespace hydro::batch
