// The gains that hydro-tune chooses, and the configuration that contains them.
#pragma once

#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "settings/stack_config.h"

namespace hydro::tune {

struct Gains {
  // rad/s, of the pressure loop at mid-stroke, with as many compressing sides as pressure.compressed_sides
  // says (for both k_p and k_v).
  double natural_frequency = 0;
  double damping_ratio = 0;
  double c1 = 0;  // psi/rad
  double c2 = 0;  // psi s/rad
  // rad/s^2, of the braking curve before eq. (17) (position_ctrl/law/position_law.h); infinity: eq. (17)
  // alone.
  double deceleration = std::numeric_limits<double>::infinity();
  bool as_configured = false;  // the configuration unchanged, regardless of the numbers above
};

// The gains that a configuration has.
Gains GainsOf(const settings::StackConfig& config);

// The configuration with these gains, with both feed-forwards of eq. (16), and with the derivative of eq.
// (17) on the measured angle. It keeps the form in which eq. (16) is given: k_p and k_v, or natural frequency
// and damping. Throws InputError when the gains of eq. (16) cannot be derived.
settings::StackConfig With(settings::StackConfig config, const Gains& gains);

// The keys that With may change, as "section.key" and its value in TOML.
std::vector<std::pair<std::string, std::string>> GainKeys(const settings::StackConfig& config);

}  // namespace hydro::tune
