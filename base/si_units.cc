#include "base/si_units.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace hydro {
namespace {

constexpr double kInch = 0.0254;                            // m
constexpr double kPoundForce = 0.45359237 * 9.80665;        // N
constexpr double kPsi = kPoundForce / (kInch * kInch);      // Pa
constexpr double kInchPound = kPoundForce * kInch;          // N m
constexpr double kCubicInch = kInch * kInch * kInch * 1e6;  // cm^3
constexpr double kKilo = 1e3;
constexpr double kMega = 1e6;

// Unprefixed pressures are separate: kPa or MPa, whichever gives the handier numbers.
constexpr std::array<SiUnit, 26> kSiUnits = {{
    {"in", "mm", kInch * 1e3},
    {"in/s", "m/s", kInch},
    {"in^2", "cm^2", kInch* kInch * 1e4},
    {"in^3", "cm^3", kCubicInch},
    {"in^3/s", "cm^3/s", kCubicInch},
    {"in^3/rad", "cm^3/rad", kCubicInch},
    {"in^3/(s psi)", "cm^3/(s MPa)", kCubicInch* kMega / kPsi},
    {"in^3/s/psi", "cm^3/s/MPa", kCubicInch* kMega / kPsi},
    {"lbf", "N", kPoundForce},
    {"in-lbf", "N m", kInchPound},
    {"in-lb", "N m", kInchPound},
    {"ft-lbf", "N m", kInchPound * 12},
    {"in-lbf-s", "N m s", kInchPound},
    {"in-lbf/rad", "N m/rad", kInchPound},
    {"in-lbf/s", "N m/s", kInchPound},
    {"in-lbf-s^2", "kg m^2", kInchPound},
    {"lbf-in-s^2", "kg m^2", kInchPound},
    {"in-lbf/V", "N m/V", kInchPound},
    {"in-lbf/psi", "N m/MPa", kInchPound* kMega / kPsi},
    {"V/psi", "V/MPa", kMega / kPsi},
    {"psi/rad", "MPa/rad", kPsi / kMega},
    {"psi s/rad", "kPa s/rad", kPsi / kKilo},
    {"psi/s", "kPa/s", kPsi / kKilo},
    {"psi/in^3", "kPa/cm^3", kPsi / kKilo / kCubicInch},
    // sqrt(psi) = 83.03 sqrt(Pa) = 0.08303 sqrt(MPa)
    {"in^3/s/psi^.5", "cm^3/s/MPa^.5", kCubicInch / 0.083034675},
    {"1/psi", "1/MPa", kMega / kPsi},
}};

}  // namespace

const SiUnit* FindSiUnit(const std::string& unit, double size) {
  static constexpr SiUnit kKilopascal{"psi", "kPa", kPsi / kKilo};
  static constexpr SiUnit kMegapascal{"psi", "MPa", kPsi / kMega};
  // NaN compares false, so that one that does not exist decides nothing.
  if (unit == "psi") return std::abs(size) * kPsi >= kMega ? &kMegapascal : &kKilopascal;
  const auto* found =
      std::find_if(kSiUnits.begin(), kSiUnits.end(), [&unit](const SiUnit& row) { return unit == row.from; });
  return found == kSiUnits.end() ? nullptr : found;
}

}  // namespace hydro
