// pump.friction_asymmetry: T_s -> T_s +/- coulomb, b -> b +/- viscous for theta' > 0 / < 0. It also acts at
// rest: the pump breaks away at T_s + coulomb forward and at T_s - coulomb backward. Both follow from a
// constant torque `coulomb` against forward rotation.

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

[[maybe_unused]] const bool kPumpFrictionAsymmetryAdded =
    AddToCatalogue({.info = {.id = "pump.friction_asymmetry",
                             .summary = "friction of the pump differs between the directions",
                             .equation = "T_s -> T_s +/- coulomb, b -> b +/- viscous for theta' > 0 / < 0",
                             .confused_with = "a torque offset, pump.quadratic_drag",
                             .parameters = {{.name = "coulomb",
                                             .unit = "in-lbf",
                                             .min = -kUnbounded,
                                             .meaning = "half the difference of Coulomb friction",
                                             .example = 1},
                                            {.name = "viscous",
                                             .unit = "in-lbf-s",
                                             .min = -kUnbounded,
                                             .meaning = "half the difference of viscous friction",
                                             .example = 0.01}}},
                    .make = MakeEffect<FrictionAsymmetry>});

}  // namespace

}  // namespace hydro::model
