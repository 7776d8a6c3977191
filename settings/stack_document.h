// A stack's configuration as a document that is being read: what stack_config.h and limb_config.h share.
#pragma once

#include <string>
#include <vector>

#include "settings/stack_config.h"
#include "settings/toml/toml_document.h"

namespace hydro::settings {

// The document in `file`, as it is. Throws InputError, also for a model in the place of a configuration.
TomlNode ReadConfigDocument(const std::string& file);

// The configuration of the stack that `root` describes: sections, checks, and the model file that it names. Throws InputError.
StackConfig StackOf(TomlNode* root, const std::string& file);

}  // namespace hydro::settings
