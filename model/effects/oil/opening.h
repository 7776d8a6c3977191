// A valve that opens gradually: closed at a drive of 0, wide open at 1. Its switch has three positions: 0
// closed, 1 between, 2 wide open. Also two such valves, from each side to the accumulator.
#pragma once

#include <algorithm>
#include <cstdint>

#include "model/effects/effect.h"

namespace hydro::model {

template <class T>
T Opening(int position, const T& drive) {
  return position <= 0 ? T(0.0) : (position == 1 ? drive : T(1.0));
}

template <class T>
T OpeningMargin(int position, const T& drive) {
  if (position <= 0) return -drive;
  return position == 1 ? std::min<T>(drive, 1.0 - drive) : T(drive - 1.0);
}

template <class T>
int8_t NextOpening(int position, const T& drive) {
  if (position == 1) return drive < T(0.5) ? 0 : 2;
  // At a start, and where a motion is known only at samples, the drive may lie beyond the ramp.
  if (position <= 0) return drive < T(1.0) ? 1 : 2;
  return drive > T(0.0) ? 1 : 0;
}

// Law::Drive(x, side) is what opens the valve of side 0 or 1. Law::kConductance is the place, among the
// effect's numbers, of the flow per pressure through a wide-open valve. Law::kReplacesValves says whether
// these valves replace the ideal ones. The flow out of a side is conductance opening (p - p3). There is one
// switch for each side.
template <class Law>
class GradualValves : public EffectOf<GradualValves<Law>> {
 public:
  int switches() const override { return 2; }
  bool replaces_valves() const override { return Law::kReplacesValves; }

  template <class T>
  void OwnTorquesAndFlows(Terms<T>& x) const {
    x.valve_flow_1 += x.own[Law::kConductance] * OpeningOf(x, 0) * (x.p1 - x.p_3);
    x.valve_flow_2 += x.own[Law::kConductance] * OpeningOf(x, 1) * (x.p2 - x.p_3);
  }

  template <class T>
  void OwnMargins(const Terms<T>& x, T* margin) const {
    for (int side = 0; side < 2; ++side) {
      margin[kFirstEffectSwitch + this->first_switch() + side] =
          OpeningMargin(Position(x, side), Law::Drive(x, side));
    }
  }

  template <class T>
  void OwnCross(int which, const Terms<T>& x, T* /*state*/, Mode* mode) const {
    mode->effects[this->first_switch() + which] = NextOpening(Position(x, which), Law::Drive(x, which));
  }

  void AddPower(const Terms<double>& x, const double* /*rate*/, Power* power) const override {
    for (int side = 0; side < 2; ++side) {
      const double over = (side == 0 ? x.p1 : x.p2) - x.p_3;
      power->effects_dissipated += x.own[Law::kConductance] * OpeningOf(x, side) * over * over;
    }
  }

 private:
  template <class T>
  int Position(const Terms<T>& x, int side) const {
    return x.mode->effects[this->first_switch() + side];
  }
  template <class T>
  T OpeningOf(const Terms<T>& x, int side) const {
    return Opening(Position(x, side), Law::Drive(x, side));
  }
};

}  // namespace hydro::model
