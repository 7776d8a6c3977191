// The checks that all trajectories share.
#pragma once

#include <string>
#include <vector>

#include "model/trajectory/trajectory.h"

namespace hydro::trajectory {

// Throws std::invalid_argument, e.g. "frequency: found nan, allowed: a finite number".
void RequireFinite(const std::string& what, double value);

// Throws std::invalid_argument unless value is finite and above 0.
void RequirePositive(const std::string& what, double value);

// Throws std::invalid_argument unless all numbers are finite and the times strictly increase. `what` is the
// singular, e.g. "step"; items count from 1.
void RequireIncreasing(const std::string& what, const std::vector<Step>& items);

}  // namespace hydro::trajectory
