// --set section.key=value.
#pragma once

#include <string>
#include <vector>

#include "settings/toml/toml_document.h"

namespace hydro::settings {

// Sets each "section.key=value" in the configuration. A value that is not TOML counts as a string. Throws
// InputError naming the option that does not have this form.
//
// When alternatives exclude each other, choosing one by option drops the file's keys for the others: the keys
// of another kind when reference.kind (or model.motion.kind) is set, k_p and k_v against
// natural_frequency_rad_s and damping_ratio, points against file and column, motion and arm_angle_rad when
// model.shaft is set.
//
// "joint.NAME.section.key=value" sets a key of the [[joint]] with that name.
void ApplyOverrides(const std::vector<std::string>& overrides, TomlNode* root);

// Lays the sections of `own` over those of `root`, key by key, as for a joint's sections over the common
// ones. A choice among alternatives drops the others, as an option does.
void Overlay(const TomlNode& own, TomlNode* root);

}  // namespace hydro::settings
