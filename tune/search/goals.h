// The user's requirements for the tuned stack.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace hydro::tune {

// Goals that are not given do not count. Without any goal, the search looks for the fastest loop that keeps
// its margins.
struct Goals {
  std::optional<double> bandwidth_hz = {};  // at least: from the reference to the arm's angle, linear, 3 dB
  std::optional<double> overshoot_percent = {};  // at most, of every step
  std::optional<double> settling_s = {};         // at most, within 2 % of the step, for `step` (0.1 rad)
  // The step to tune for, together with 0.8 and 1.25 times it; without it, a range of steps.
  std::optional<double> step = {};

  bool any() const { return bandwidth_hz || overshoot_percent || settling_s; }
};

// Parses "bandwidth_hz=3" and so on. `unit` is the unit of the arm's coordinate: steps are in this unit or
// are converted to it. Throws InputError for an unknown or repeated goal and for a value outside its range.
Goals ParseGoals(const std::vector<std::string>& texts, const std::string& unit = "rad");

}  // namespace hydro::tune
