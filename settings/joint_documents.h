// Splits a configuration with [[joint]] sections into one document for each joint: the common settings,
// overlaid with the joint's own.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "settings/toml/toml_document.h"

namespace hydro::settings {

struct JointDocument {
  std::string name;
  TomlNode root;  // the whole configuration of a stack with this joint alone
};

// A limb has no more joints. In a log, more than these are forged channels.
inline constexpr size_t kMostJoints = 1000;

// Whether the document describes several joints: it has a [[joint]] section.
bool HasJoints(const TomlNode& root);

// The names of its joints, in the document's order. Throws InputError for a name that is missing, that does
// not fit in a channel's suffix, or that occurs twice, and for more than kMostJoints.
std::vector<std::string> JointNames(const TomlNode& root);

// What tells a joint's channels from the others': the configuration's own suffix, followed by "_" and the
// joint's name.
std::string JointSuffix(const std::string& common_suffix, const std::string& joint);

// Returns the joint that `overrides` choose ("joint=NAME", for which --joint is short) and removes the choice
// from them.
std::optional<std::string> TakeJointChoice(std::vector<std::string>* overrides);

// Makes a document for each joint. `overrides` ("section.key=value") apply to every joint and override its
// own values too; those that begin with "joint.NAME." apply to that joint alone. noise.seed counts up from
// joint to joint, so that their noise differs, unless a joint states its own. Throws InputError.
std::vector<JointDocument> SplitJoints(const TomlNode& root, const std::vector<std::string>& overrides);

}  // namespace hydro::settings
