// What a user asks of the tuned stack.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace hydro::tune {

// What is not given is not asked for. Without any, the fastest loop is looked for that keeps its margins.
struct Goals {
  std::optional<double> bandwidth_hz = {};  // at least: of the arm's angle from its reference, linear, 3 dB
  std::optional<double> overshoot_percent = {};  // at most, of every step
  std::optional<double> settling_s = {};         // at most, within 2 % of the step, for `step` (0.1 rad)
  // The step to tune for, with 0.8 and 1.25 times it; else a range of steps.
  std::optional<double> step = {};

  bool any() const { return bandwidth_hz || overshoot_percent || settling_s; }
};

// Of "bandwidth_hz=3" and so on; `unit` is that of the arm's coordinate, in which a step is, or is brought to. Throws InputError for an unknown or repeated goal and for a value outside its range.
Goals ParseGoals(const std::vector<std::string>& texts, const std::string& unit = "rad");

}  // namespace hydro::tune
