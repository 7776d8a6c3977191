// Builds the stacks of a limb's joints, and tells to which joint an error in one of them belongs.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "settings/joint_documents.h"
#include "settings/stack_config.h"

namespace hydro::settings {

// The configuration of the stack in `documents[index]`, of the limb that `root` describes. Throws InputError;
// it names the joint when the error stands in the joint's own section, or concerns this joint and not all of
// them.
StackConfig StackOfDocument(const TomlNode& root, const std::vector<JointDocument>& documents, size_t index,
                            const std::string& file);

}  // namespace hydro::settings
