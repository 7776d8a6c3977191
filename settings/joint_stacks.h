// The stacks of a limb's joints, and whose an error in one of them is.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "settings/joint_documents.h"
#include "settings/stack_config.h"

namespace hydro::settings {

// The configuration of the stack in `documents[index]`, of the limb that `root` describes. Throws InputError; it names the joint where what
// is wrong stands in its own section or is wrong for this joint and not for all.
StackConfig StackOfDocument(const TomlNode& root, const std::vector<JointDocument>& documents, size_t index,
                            const std::string& file);

}  // namespace hydro::settings
