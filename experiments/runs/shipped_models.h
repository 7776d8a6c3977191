// The model files of config/models/, compiled in, so that an experiment needs no path.
#pragma once

#include <string>

#include "model/terms/description.h"

namespace hydro::experiments {

// The text of config/models/NAME.toml. Throws std::out_of_range for an unknown name.
const std::string& ShippedModelText(const std::string& name);
model::ModelDescription ShippedModel(const std::string& name);

}  // namespace hydro::experiments
