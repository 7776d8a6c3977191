// pump.shear_thinning: + viscous theta' / (1 + |theta'|/speed) in eq. (4). The lubricant's viscosity falls
// under shear from that at rest to that of b: Cross's law with exponent 1 (M. M. Cross, Rheology of
// non-Newtonian fluids, 1965). Greased gears show it most.

#include "model/effects/effect.h"

namespace hydro::model {

namespace {

class ShearThinning : public EffectOf<ShearThinning> {
 public:
  template <class T>
  void OwnTorquesAndFlows(Terms<T>& x) const {
    // The mode knows the direction of slip, so the term stays smooth although |theta'| is not.
    const T speed = static_cast<double>(x.mode->pump) * x.motor_speed;
    x.load += x.own[0] * x.motor_speed / (1 + speed / x.own[1]);
  }
};

[[maybe_unused]] const bool kPumpShearThinningAdded =
    AddToCatalogue({.info = {.id = "pump.shear_thinning",
                             .summary = "viscous friction grows less than in proportion to the speed",
                             .equation = "+ viscous theta' / (1 + abs(theta')/speed)",
                             .confused_with = "parameters T_s and b, pump.stribeck",
                             .parameters = {{.name = "viscous",
                                             .unit = "in-lbf-s",
                                             .meaning = "viscous friction at rest, beside b",
                                             .example = 0.2},
                                            {.name = "speed",
                                             .unit = "rad/s",
                                             .min_allowed = false,
                                             .meaning = "motor speed at which it has fallen to half",
                                             .starts = {0.02, 0.1, 0.5},
                                             .scale = Scale::kSpeed,
                                             .example = 5}}},
                    .make = MakeEffect<ShearThinning>});

}  // namespace

}  // namespace hydro::model
