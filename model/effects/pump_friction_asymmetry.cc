// pump.friction_asymmetry: T_s -> T_s +/- coulomb, b -> b +/- viscous for theta' > 0 / < 0. At rest too:
// forward the pump breaks away at T_s + coulomb, backward at T_s - coulomb. Both follow from a constant
// torque `coulomb` against forward rotation.

#include "model/effects/effect.h"

namespace hydro::model {

namespace {

class FrictionAsymmetry : public EffectOf<FrictionAsymmetry> {
 public:
  template <class T>
  void OwnTorquesAndFlows(Terms<T>& x) const {
    x.load += x.own[0] + x.own[1] * static_cast<double>(x.mode->pump) * x.motor_speed;
  }
};

}  // namespace

CatalogueEntry PumpFrictionAsymmetry();
CatalogueEntry PumpFrictionAsymmetry() {
  return {
      {"pump.friction_asymmetry",
       "friction of the pump differs between the directions",
       "T_s -> T_s +/- coulomb, b -> b +/- viscous for theta' > 0 / < 0",
       "a torque offset, pump.quadratic_drag",
       {{"coulomb", "in-lbf", -kUnbounded, kUnbounded, true, "half the difference of Coulomb friction"},
        {"viscous", "in-lbf-s", -kUnbounded, kUnbounded, true, "half the difference of viscous friction"}}},
      MakeEffect<FrictionAsymmetry>};
}

}  // namespace hydro::model
