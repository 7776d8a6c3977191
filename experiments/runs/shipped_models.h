// The model files of config/models/ and the stack configurations of config/, compiled in, so that an
// experiment needs no path.
#pragma once

#include <string>
#include <vector>

#include "model/terms/description.h"

namespace hydro::experiments {

// The text of config/models/NAME.toml. Throws std::out_of_range for an unknown name.
const std::string& ShippedModelText(const std::string& name);
model::ModelDescription ShippedModel(const std::string& name);

// The text of config/NAME.toml with each "section.key=value" of `overrides` applied as --set does. Throws
// std::out_of_range for an unknown name, InputError for a faulty override.
std::string ShippedStackText(const std::string& name, const std::vector<std::string>& overrides = {});

}  // namespace hydro::experiments
