// The units that a model's values are in, and how the paper's units read in them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace hydro {

// Every unit follows from those of length and force, so the values are coherent. Time is in s, angles are in
// rad and the command in V in every system, as in the messages and logs of the stack. The default is the
// paper's. The names point to the constant table of base/units.
struct UnitSystem {
  std::string_view length = "in";
  std::string_view force = "lbf";
  bool linear_arm = false;  // the arm's coordinate is a length, that of a cylinder, not an angle

  bool operator==(const UnitSystem&) const = default;

  // The unit here of a quantity that the paper has in `paper`: "psi" is "Pa", "in-lbf/V" is "N m/V". `arm` is
  // the power of the arm's coordinate in the quantity: 1 for arm_speed, -2 for J_a. A text that is not a unit
  // comes back unchanged.
  std::string UnitFor(const std::string& paper, int arm = 0) const;
};

// m, N: Pa for pressures.
inline constexpr UnitSystem kSiUnits{"m", "N", false};

// What a model file may name, from the table of base/units.
std::vector<std::string> LengthUnits();
std::vector<std::string> ForceUnits();

}  // namespace hydro
