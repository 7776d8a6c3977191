// Coulomb friction that grows with a torque that a gear transmits, on the motor's side or on the load's.
#pragma once

#include <cmath>

#include "model/effects/effect.h"

namespace hydro::model {

// Side::Torque(x) is that torque, once every torque on the shaft is known. |y| is approximated by sqrt(y^2 +
// w^2) - w with w = 1e-3 T_pmax, whose slope at y = 0 does not jump.
template <class Side>
class GearFriction : public EffectOf<GearFriction<Side>> {
 public:
  template <class T>
  void OwnStates(Terms<T>& x, T* /*rate*/) const {
    using std::sqrt;
    const T w = 1e-3 * x.parameters->T_pmax;
    const T y = Side::Torque(x);
    const T friction = x.own[0] * (sqrt(y * y + w * w) - w);
    x.coulomb += friction;
    x.breakaway += friction;
  }
};

}  // namespace hydro::model
