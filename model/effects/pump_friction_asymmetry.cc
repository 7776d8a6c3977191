// pump.friction_asymmetry: T_s -> T_s +/- coulomb, b -> b +/- viscous for theta' > 0 / < 0. At rest too:
// forward the pump breaks away at T_s + coulomb, backward at T_s - coulomb. Both follow from a constant
// torque `coulomb` against forward rotation.
#include <ceres/jet.h>

#include "model/effects/effect.h"

namespace hydro {

namespace {

class FrictionAsymmetry : public EffectOf<FrictionAsymmetry> {
 public:
  FrictionAsymmetry(double coulomb, double viscous) : coulomb_(coulomb), viscous_(viscous) {}

  template <class T>
  void OwnTorquesAndFlows(Terms<T>& x) const {
    x.load += coulomb_ + viscous_ * static_cast<double>(x.mode->pump) * x.motor_speed;
  }

 private:
  double coulomb_;
  double viscous_;
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
      [](const EffectDescription& description, const Parameters&) -> std::unique_ptr<Effect> {
        return std::make_unique<FrictionAsymmetry>(description.parameters.at("coulomb"),
                                                   description.parameters.at("viscous"));
      }};
}

}  // namespace hydro
