// Units of measurement: the only table of them, and the SI units in which figures are shown (--si).
#pragma once

#include <array>
#include <numbers>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace hydro {

inline constexpr double kInch = 0.0254;                        // m
inline constexpr double kPoundForce = 0.45359237 * 9.80665;    // N
inline constexpr double kPsi = kPoundForce / (kInch * kInch);  // Pa
inline constexpr double kInchPound = kPoundForce * kInch;      // N m
inline constexpr double kGravity = 9.80665 / kInch;            // in/s^2
inline constexpr double kRpm = std::numbers::pi / 30;          // rad/s
inline constexpr double kDegree = std::numbers::pi / 180;      // rad

constexpr double Degrees(double radians) { return radians * 180 / std::numbers::pi; }

struct Unit {
  double size = 1;                 // in the coherent SI unit of the same powers
  std::array<double, 7> powers{};  // of m, kg, s, V, rad, K and A
};

// Reads a unit as the programs write it: names from the table, joined by "-" or a blank (times) and "/"
// (divided by), with powers and brackets: "in-lbf/rad", "in^3/(s psi)", "1/psi", "in^3/s/psi^.5". Empty when
// the text is not a unit.
std::optional<Unit> ParseUnit(std::string_view text);

// "rad_s" for "rad/s", for use in names.
std::string UnitInName(const std::string& unit);

// A unit of the table to a power.
struct UnitPower {
  std::string_view name;
  double power = 1;
};

// The parts of such a text in their order: in^3, s^-1 and psi^-1 for "in^3/(s psi)".
std::optional<std::vector<UnitPower>> UnitPowers(std::string_view text);

// The table's names.
std::vector<std::string_view> UnitNames();

struct SiUnit {
  std::string from;
  std::string to;
  double factor;  // value in `to` = factor * value in `from`
};

// The SI unit in which to show a figure that is given in the paper's units or a model's own; empty when that
// is the same unit, or when there is none for it. `size`, the largest value to be shown, decides between kPa
// and MPa.
std::optional<SiUnit> FindSiUnit(const std::string& unit, double size);

}  // namespace hydro
