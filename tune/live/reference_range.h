// Checks whether the rig can follow a reference, using the model's numbers and the limits in force. Pure.
#pragma once

#include <string>

#include "settings/stack_config.h"

namespace hydro::tuning {

// One line: how the reference exceeds the limits or the motor's torque or speed, and what these allow. Empty:
// the rig can follow.
std::string WhatTheRigCannotFollow(const settings::StackConfig& config);

}  // namespace hydro::tuning
