// valve.pilot_check: pilot-operated check valves between each side and the accumulator, as in circuits for
// cylinders with a rod on one side. A valve opens to a side that falls below p3. Pushed by the other side's
// pressure, it also lets oil out of its own side. For side 1, with a pilot piston of `ratio` times the seat's
// area,
//   drive = (p3 - p1 + ratio (p2 - p3) - cracking)/range,
// from closed at 0 to wide open at 1, and the flow out of the side is conductance opening (p1 - p3). The
// piston pushes and never pulls: p2 below p3 counts as p3. This is a corner in the valve's drive, not in its
// flow. The valves replace the ideal ones. One switch for each side. A data sheet that states ratio and
// cracking alone is a whole description: range and conductance have standards.

#include <algorithm>
#include <cmath>

#include "model/effects/oil/opening.h"

namespace hydro::model {

namespace {

// Nearly a switch: from closed to wide open in a hundredth of the largest pressure that the motor can make.
template <class T>
T StandardRange(const ParametersOf<T>& p) {
  return 0.01 * p.T_pmax / p.D;
}

// That hundredth also carries the pump's flow through the open valve, at the speed w at which the motor's
// kinetic energy is that of oil compressed to T_pmax/D on both sides: J w^2/2 = V_ms/beta (T_pmax/D)^2.
template <class T>
T StandardConductance(const ParametersOf<T>& p) {
  using std::sqrt;
  return 100.0 * p.D * sqrt(2.0 * p.V_ms / (p.beta * p.J));
}

struct Pilot {
  static constexpr int kConductance = 3;
  static constexpr bool kReplacesValves = true;

  template <class T>
  static T Drive(const Terms<T>& x, int side) {
    const T& own = side == 0 ? x.p1 : x.p2;
    const T& other = side == 0 ? x.p2 : x.p1;
    const T pilot = std::max<T>(other - x.p_3, T(0.0));
    return (x.p_3 - own + x.own[0] * pilot - x.own[1]) / x.own[2];
  }
};

[[maybe_unused]] const bool kValvePilotCheckAdded = AddToCatalogue(
    {.info = {.id = "valve.pilot_check",
              .summary = "pilot-operated check valves from the accumulator to each side",
              .equation = "the valve of a side opens with (p3 - p + ratio max(p_other - p3, 0) - "
                          "cracking)/range, 0 to 1, and lets "
                          "conductance opening (p - p3) out",
              .confused_with = "valve.check, valve.flushing",
              .parameters = {{.name = "ratio",
                              .unit = "1",
                              .meaning = "area of the pilot piston over that of the seat",
                              .starts = {3},
                              .example = 3},
                             {.name = "cracking",
                              .unit = "psi",
                              .meaning = "pressure at which the valve begins to open",
                              .starts = {0.1},
                              .scale = Scale::kCharge,
                              .example = 10},
                             {.name = "range",
                              .unit = "psi",
                              .min_allowed = false,
                              .meaning = "pressure from closed to wide open",
                              .starts = {0.3},
                              .scale = Scale::kCharge,
                              .example = 40,
                              .optional = true,
                              .standard = {"0.01 T_pmax/D", [](const auto& p) { return StandardRange(p); }}},
                             {.name = "conductance",
                              .unit = "in^3/s/psi",
                              .meaning = "flow per pressure where it is wide open",
                              .starts = {30},
                              .scale = Scale::kFlow,
                              .example = 0.005,
                              .optional = true,
                              .standard = {"100 D sqrt(2 V_ms/(beta J))",
                                           [](const auto& p) { return StandardConductance(p); }}}},
              .needs_oil = true,
              // A symmetric actuator does not need such valves.
              .on_request = true},
     .make = MakeEffect<GradualValves<Pilot>>});

}  // namespace

}  // namespace hydro::model
