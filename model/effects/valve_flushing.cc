// valve.flushing: a shuttle that connects the side of the lower pressure to the accumulator, as it is used to exchange hot oil and to
// take the surplus of unequal areas. Of side 1, opening = (p2 - p1 - shift)/range from 0 to 1, and the flow out of the side is
// conductance opening (p1 - p3). One switch for each side.

#include "model/effects/effect.h"
#include "model/effects/opening.h"

namespace hydro::model {

namespace {

class Flushing : public EffectOf<Flushing> {
 public:
  int switches() const override { return 2; }

  template <class T>
  void OwnTorquesAndFlows(Terms<T>& x) const {
    x.valve_flow_1 += x.own[2] * Opening(Position(x, 0), Drive(x, 0)) * (x.p1 - x.p_3);
    x.valve_flow_2 += x.own[2] * Opening(Position(x, 1), Drive(x, 1)) * (x.p2 - x.p_3);
  }

  template <class T>
  void OwnMargins(const Terms<T>& x, T* margin) const {
    for (int side = 0; side < 2; ++side) {
      margin[kFirstEffectSwitch + first_switch() + side] = OpeningMargin(Position(x, side), Drive(x, side));
    }
  }

  template <class T>
  void OwnCross(int which, const Terms<T>& x, T* /*state*/, Mode* mode) const {
    mode->effects[first_switch() + which] = NextOpening(Position(x, which), Drive(x, which));
  }

  void AddPower(const Terms<double>& x, const double* /*rate*/, Power* power) const override {
    for (int side = 0; side < 2; ++side) {
      const double over = (side == 0 ? x.p1 : x.p2) - x.p_3;
      power->effects_dissipated += x.own[2] * Opening(Position(x, side), Drive(x, side)) * over * over;
    }
  }

 private:
  template <class T>
  int Position(const Terms<T>& x, int side) const {
    return x.mode->effects[first_switch() + side];
  }
  template <class T>
  static T Drive(const Terms<T>& x, int side) {
    const T dp = x.p2 - x.p1;
    return ((side == 0 ? dp : T(-dp)) - x.own[0]) / x.own[1];
  }
};

[[maybe_unused]] const bool kAdded =
    AddToCatalogue({.info = {.id = "valve.flushing",
                             .summary = "a shuttle opens the side of the lower pressure to the accumulator",
                             .equation = "the side of the lower pressure loses conductance opening (p - p3), "
                                         "opening = (abs(dp) - shift)/range "
                                         "from 0 to 1",
                             .confused_with = "parameter c_E, valve.pilot",
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
                             // Its owner knows of it, and one-way valves hold the lower side near p3 as well.
                             .on_request = true},
                    .make = MakeEffect<Flushing>});

}  // namespace

}  // namespace hydro::model
