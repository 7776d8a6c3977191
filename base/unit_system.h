// The units of a model's values, and how the paper's units translate into them.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace hydro {

// Every unit follows from those of length and force, so the values are coherent. In every system, time is in
// s, angles are in rad and the command is in V, as in the messages and logs of the stack. The default system
// is the paper's. The names point to the constant table of base/units.
struct UnitSystem {
  std::string_view length = "in";
  std::string_view force = "lbf";
  bool linear_arm = false;  // the arm's coordinate is a length, as of a cylinder, not an angle

  bool operator==(const UnitSystem&) const = default;

  // The unit in this system of a quantity that has the unit `paper` in the paper: "psi" is "Pa", "in-lbf/V"
  // is "N m/V". `arm` is the power of the arm's coordinate in the quantity: 1 for arm_speed, -2 for J_a. A
  // text that is not a unit comes back unchanged.
  std::string UnitFor(const std::string& paper, int arm = 0) const;
};

// m, N: Pa for pressures.
inline constexpr UnitSystem kSiUnits{"m", "N", false};

// The units that a model file may name, from the table of base/units.
std::vector<std::string> LengthUnits();
std::vector<std::string> ForceUnits();

// Recognises units that are spelled in another way than the programs spell them (units.h).

// The unit that is meant by a text which is not one, as the programs write it: "N m" for "Nm", "MPa" for
// "mpa", "deg/s" for "°/s". The unit has the same quantity as `wanted`. Empty: none.
std::string UnitMeant(std::string_view text, std::string_view wanted);

// This project's spelling of a unit, if `unit` is another spelling that has no other meaning; otherwise the
// text itself.
std::string_view OurSpelling(std::string_view unit);

}  // namespace hydro
