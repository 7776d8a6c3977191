// valve.flushing: a shuttle that connects the side of the lower pressure to the accumulator, used to exchange
// hot oil and to drain the surplus of unequal areas. For side 1, opening = (p2 - p1 - shift)/range from 0 to
// 1, and the flow out of the side is conductance opening (p1 - p3). One switch for each side.

#include "model/effects/oil/opening.h"

namespace hydro::model {

namespace {

struct Flushing {
  static constexpr int kConductance = 2;
  static constexpr bool kReplacesValves = false;

  template <class T>
  static T Drive(const Terms<T>& x, int side) {
    const T dp = x.p2 - x.p1;
    return ((side == 0 ? dp : T(-dp)) - x.own[0]) / x.own[1];
  }
};

[[maybe_unused]] const bool kValveFlushingAdded =
    AddToCatalogue({.info = {.id = "valve.flushing",
                             .summary = "a shuttle opens the side of the lower pressure to the accumulator",
                             .equation = "the side of the lower pressure loses conductance opening (p - p3), "
                                         "opening = (abs(dp) - shift)/range "
                                         "from 0 to 1",
                             .confused_with = "parameter c_E, valve.pilot_check",
                             .parameters = {{.name = "shift",
                                             .unit = "psi",
                                             .meaning = "pressure difference at which the shuttle moves",
                                             .starts = {0.2},
                                             .scale = Scale::kPressure,
                                             .example = 50},
                                            {.name = "range",
                                             .unit = "psi",
                                             .min_allowed = false,
                                             .meaning = "pressure difference from closed to wide open",
                                             .starts = {0.1},
                                             .scale = Scale::kPressure,
                                             .example = 40},
                                            {.name = "conductance",
                                             .unit = "in^3/s/psi",
                                             .meaning = "flow per pressure where it is wide open",
                                             .example = 0.002}},
                             .needs_oil = true,
                             // The owner of such a valve knows about it, and one-way valves also hold the
                             // lower side near p3.
                             .on_request = true},
                    .make = MakeEffect<GradualValves<Flushing>>});

}  // namespace

}  // namespace hydro::model
