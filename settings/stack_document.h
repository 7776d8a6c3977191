// A stack's configuration as a document that is being read; stack_config.h and limb_config.h share this.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "settings/model_file.h"
#include "settings/stack_config.h"
#include "settings/toml/toml_document.h"

namespace hydro::settings {

// Reads the document in `file` without changes. Throws InputError, also for a model file in place of a
// configuration.
TomlNode ReadConfigDocument(const std::string& file);

// The configuration of the stack that `root` describes: sections, checks, and the model file that it names.
// Throws InputError.
StackConfig StackOf(TomlNode* root, const std::string& file, ModelFiles* models);

// Throws InputError where the command line has given `root`, whose file names the model `written`, a model in
// other units, so that a number of the configuration would mean another value, and where the model cannot be
// read.
void CheckUnitsOfOtherModel(const std::string& written, const TomlNode& root, const std::string& file,
                            ModelFiles* models);

// The model that a document names; empty where it names none, which the section's reader reports.
std::string ModelNameIn(const TomlNode& root);

// The same for the numbers of a part of `root`, which are in the units `was`, with a model in the units `is`.
void CheckNumbersKeepTheirUnits(const TomlNode& numbers, const TomlNode& root, const UnitSystem& was,
                                const UnitSystem& is);

// The units of the model that the configuration names; the paper's where it names none. Throws InputError
// where there is no such file.
UnitSystem UnitsOfModelIn(const TomlNode& root, const std::string& file, ModelFiles* models);

// The stack of one joint of the limb that `root` describes. Throws InputError, also when no joint is chosen.
StackConfig StackOfJoint(TomlNode root, const std::vector<std::string>& overrides,
                         const std::optional<std::string>& joint);

}  // namespace hydro::settings
