#include "batch/study/case_inputs.h"

#include <algorithm>

#include "base/text_file.h"
#include "batch/study/key.h"
#include "model/terms/parameter_info.h"
#include "settings/model_file.h"
#include "settings/overrides.h"

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

// The machine is the case's model with changes of its own.
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

}  // namespace hydro::batch
