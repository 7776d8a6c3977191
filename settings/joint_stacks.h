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

// Throws InputError where a number would change its meaning with the units of a joint's model: a number of the file when an option gives
// a joint another model, and one of the sections that hold for all joints when a joint's own model is in other units than theirs.
// `before` is the limb as in its file, `root` and `documents` are with the options.
void CheckUnitsOfJoints(const TomlNode& before, const TomlNode& root,
                        const std::vector<JointDocument>& documents, const std::string& file);

}  // namespace hydro::settings
