// Whether the rig can follow a reference, by the model's numbers and the limits in force. Pure.
#pragma once

#include <string>

#include "settings/stack_config.h"

namespace hydro::tuning {

// One line: what the reference asks for beyond the limits, the motor's torque or its speed, and what these allow;
// empty: the rig can follow.
std::string WhatTheRigCannotFollow(const settings::StackConfig& config);

}  // namespace hydro::tuning
