// A stack's configuration as a document that is being read: what stack_config.h and limb_config.h share.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "settings/stack_config.h"
#include "settings/toml/toml_document.h"

namespace hydro::settings {

// The document in `file`, as it is. Throws InputError, also for a model in the place of a configuration.
TomlNode ReadConfigDocument(const std::string& file);

// The configuration of the stack that `root` describes: sections, checks, and the model file that it names. Throws InputError.
StackConfig StackOf(TomlNode* root, const std::string& file);

// The units of the model that the configuration names: the paper's where there is no such file, of which its reader tells.
UnitSystem UnitsOfModelIn(const TomlNode& root, const std::string& file);

// --set model.file gives a configuration another model. Its numbers stay those of the one that it names itself, `before` the options:
// throws InputError where that is in other units.
void CheckUnitsOfOtherModel(const TomlNode& before, const TomlNode& root, const std::string& file);

// The same for the numbers of a part of `root`, which are meant in the units `was`, with a model in `is`.
void CheckNumbersKeepTheirUnits(const TomlNode& numbers, const TomlNode& root, const UnitSystem& was,
                                const UnitSystem& is);

// The stack of one joint of the limb that `root` describes; none chosen is an error too. Throws InputError.
StackConfig StackOfJoint(TomlNode root, const std::vector<std::string>& overrides,
                         const std::optional<std::string>& joint);

}  // namespace hydro::settings
