// A torque on the motor's shaft, against forward rotation, that depends only on the shaft's angle: it returns
// the energy that it takes.
#pragma once

#include "model/effects/effect.h"

namespace hydro::model {

// Law::Torque(x) is the torque. Law::Load(x) is what it loads: the motor itself (Terms::load) or what is
// attached to its shaft (Terms::shaft_load).
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
