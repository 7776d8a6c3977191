// The speed of the fastest oscillation of a configuration's model. It determines how long the simulation of a
// tick takes.
#pragma once

#include <string>
#include <vector>

#include "settings/limb_config.h"
#include "settings/stack_config.h"

namespace hydro::design {

// rad/s, the fastest oscillation at the points where the configuration works; 0: nothing oscillates. Throws
// model::ModelError.
double FastestMotion(const settings::StackConfig& config);

// One line for a person if a tick has so many oscillations that its simulation takes far longer than the
// tick: a parameter may be mistyped, or in another unit. Otherwise empty. Throws InputError for oscillations
// that no such machine has and no simulation follows.
std::string FastMotionRemark(const settings::StackConfig& config);

// What a person should know of a stack, or of a limb, before it is simulated, one line each: the same from
// every program.
std::vector<std::string> RemarksOn(const settings::StackConfig& config);
std::vector<std::string> RemarksOn(const settings::LimbConfig& limb);

}  // namespace hydro::design
