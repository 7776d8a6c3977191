// pump.pressure_friction: the paper's f in eq. (4), Coulomb friction that grows with the pressures, + f (p1 +
// p2) sgn(theta').

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

}  // namespace

CatalogueEntry PumpPressureFriction();
CatalogueEntry PumpPressureFriction() {
  return {{"pump.pressure_friction",
           "friction of the pump grows with the pressures",
           "+ f (p1 + p2) sgn(theta')",
           "parameter k_1 or D when only one quadrant is run",
           {{"f", "in-lbf/psi", 0, kUnbounded, true,
             "Coulomb friction per pressure, added to the base parameter f"}}},
          MakeEffect<PressureFriction>};
}

}  // namespace hydro::model
