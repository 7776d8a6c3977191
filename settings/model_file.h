// Model files: TOML with the paper's parameters and the effects that were added to its equations.
#pragma once

#include <string>

#include "base/input_error.h"
#include "model/description.h"

namespace hydro {

// Reads and checks a model file. Throws InputError naming file, line and key.
ModelDescription LoadModelFile(const std::string& file);
ModelDescription ParseModel(const std::string& text, const std::string& name_for_messages);

// The TOML text of a model; ParseModel gives the same description back, bit by bit.
std::string FormatModel(const ModelDescription& description);

}  // namespace hydro
