// The shipped stacks, with changes.
#pragma once

#include <string>
#include <vector>

#include "experiments/runs/shipped_models.h"
#include "settings/model_file.h"
#include "settings/stack_config.h"

namespace hydro::tune {

inline settings::StackConfig Retuned(
    const std::vector<std::string>& overrides = {},
    const model::ModelDescription& model = experiments::ShippedModel("table1")) {
  return settings::ParseStackConfig(experiments::ShippedStackText("retuned", overrides), "stack.toml",
                                    settings::FormatModel(model), "model.toml");
}

}  // namespace hydro::tune
