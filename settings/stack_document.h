// A stack's configuration as a document that is being read; stack_config.h and limb_config.h share this.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "settings/stack_config.h"
#include "settings/toml/toml_document.h"

namespace hydro::settings {

// Reads the document in `file` without changes. Throws InputError, also for a model file in place of a
// configuration.
TomlNode ReadConfigDocument(const std::string& file);

// The configuration of the stack that `root` describes: sections, checks, and the model file that it names.
// Throws InputError.
StackConfig StackOf(TomlNode* root, const std::string& file);

// The stack of one joint of the limb that `root` describes. Throws InputError, also when no joint is chosen.
StackConfig StackOfJoint(TomlNode root, const std::vector<std::string>& overrides,
                         const std::optional<std::string>& joint);

}  // namespace hydro::settings
