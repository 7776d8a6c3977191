// pump.pressure_friction: the paper's f in eq. (4), Coulomb friction that grows with the pressures,
// + f (p1 + p2) sgn(theta').

#include "model/effects/effect.h"

namespace hydro::model {

namespace {

class PressureFriction : public EffectOf<PressureFriction> {
 public:
  template <class T>
  void OwnProperties(Terms<T>& x) const {
    x.f += x.own[0];
  }
};

[[maybe_unused]] const bool kPumpPressureFrictionAdded = AddToCatalogue(
    {.info = {.id = "pump.pressure_friction",
              .summary = "friction of the pump grows with the pressures",
              .equation = "+ f (p1 + p2) sgn(theta')",
              .confused_with = "parameter k_1 or D when only one quadrant is run",
              .parameters = {{.name = "f",
                              .unit = "in-lbf/psi",
                              .meaning = "Coulomb friction per pressure, added to the base parameter f",
                              .adds_to = &Parameters::f,
                              .example = 0.001}},
              .needs_oil = true},
     .make = MakeEffect<PressureFriction>});

}  // namespace

}  // namespace hydro::model
