// How fast the fastest oscillation of a configuration's model is: what decides how long a tick takes to
// simulate.
#pragma once

#include <string>

#include "settings/stack_config.h"

namespace hydro::design {

// rad/s, of the fastest oscillation at the points where the configuration works; 0: nothing oscillates.
// Throws model::ModelError.
double FastestMotion(const settings::StackConfig& config);

// One line for a person where a tick has so many oscillations that it takes far longer to simulate than it
// lasts: a parameter may be mistyped, or in another unit. Empty: it has not.
std::string FastMotionRemark(const settings::StackConfig& config);

}  // namespace hydro::design
