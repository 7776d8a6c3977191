// The parts of a limb: the stacks of its joints, to which joint an error in one of them belongs, and which
// process runs which joint.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "settings/joint_documents.h"
#include "settings/model_file.h"
#include "settings/stack_config.h"

namespace hydro::settings {

// The configuration of the stack in `documents[index]`, of the limb that `root` describes. Throws InputError;
// it names the joint when the error stands in the joint's own section, or concerns this joint and not all of
// them.
StackConfig StackOfDocument(const TomlNode& root, const std::vector<JointDocument>& documents, size_t index,
                            const std::string& file, ModelFiles* models);

// The model that each joint of the limb names, its own or that of all joints.
std::vector<std::string> ModelsOfJoints(const TomlNode& root);

// Throws InputError where a number would change its meaning with the units of a joint's model. It may be a
// number of the file, when an option gives a joint another model, or one in the sections for all joints, when
// a joint's own model is in other units than these. `written` are the models that the file names; `root` and
// `documents` include the options.
void CheckUnitsOfJoints(const std::vector<std::string>& written, const TomlNode& root,
                        const std::vector<JointDocument>& documents, const std::string& file,
                        ModelFiles* models);

// The joints that a process of a limb runs, in the order of the configuration.
std::vector<std::string> JointsOf(const ProcessSection& process, const StackConfig& common);

// Checks that one process, or one stack of processes, runs each joint. Throws InputError naming the place of
// a section.
void CheckProcesses(const StackConfig& common);

// Checks that one process simulates everything that couples the joints. Throws InputError.
void CheckArmIsWhole(const StackConfig& common);

}  // namespace hydro::settings
