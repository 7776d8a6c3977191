// A configuration with [[joint]] sections as one document for each joint: what the joints have in common, with what is the
// joint's own over it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "settings/toml/toml_document.h"

namespace hydro::settings {

struct JointDocument {
  std::string name;
  TomlNode root;  // the whole configuration of a stack with this joint alone
};

// Whether the document describes several joints: it has a [[joint]] section.
bool HasJoints(const TomlNode& root);

// The names of its joints, in the document's order. Throws InputError for a name that is missing, unfit for a channel's suffix, or
// there twice.
std::vector<std::string> JointNames(const TomlNode& root);

// What separates a joint's channels from the others': "_" and its name, behind the configuration's own suffix.
std::string JointSuffix(const std::string& common_suffix, const std::string& joint);

// The joint that `overrides` choose ("joint=NAME", which --joint is short for); takes the choice off them.
std::optional<std::string> TakeJointChoice(std::vector<std::string>* overrides);

// A document for each joint. `overrides` ("section.key=value") hold for every joint, also over what is its own; those that begin with
// "joint.NAME." for that one. noise.seed counts up from joint to joint, so that their noise differs, unless a joint states its own.
// Throws InputError.
std::vector<JointDocument> SplitJoints(const TomlNode& root, const std::vector<std::string>& overrides);

}  // namespace hydro::settings
