// A torque on the motor's shaft that depends on its angle alone, against forward rotation: what it takes it gives back.
#pragma once

#include "model/effects/effect.h"

namespace hydro::model {

// Law::Torque(x): the torque. Law::Load(x): what it loads, the motor itself (Terms::load) or what hangs on its shaft
// (Terms::shaft_load).
template <class Law>
class ShaftTorque : public EffectOf<ShaftTorque<Law>> {
 public:
  template <class T>
  void OwnTorquesAndFlows(Terms<T>& x) const {
    Law::Load(x) += Law::Torque(x);
  }

  void AddPower(const Terms<double>& x, const double* /*rate*/, Power* power) const override {
    const double stored = Law::Torque(x) * x.motor_speed;
    power->viscous -= stored;  // which contains it as part of the load
    power->effects_stored += stored;
  }
};

}  // namespace hydro::model
