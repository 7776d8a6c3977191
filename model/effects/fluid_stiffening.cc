// fluid.stiffening: beta + slope p on each side, with its own pressure at the actuator.

#include "model/effects/effect.h"

namespace hydro::model {

namespace {

class Stiffening : public EffectOf<Stiffening> {
 public:
  template <class T>
  void OwnProperties(Terms<T>& x) const {
    x.beta_1 += x.own[0] * x.p1;
    x.beta_2 += x.own[0] * x.p2;
  }
};

}  // namespace

CatalogueEntry FluidStiffening();
CatalogueEntry FluidStiffening() {
  return {{"fluid.stiffening",
           "the bulk modulus grows with pressure",
           "beta + slope p",
           "fluid.entrained_air",
           {{"slope", "1", 0, kUnbounded, true, "bulk modulus per pressure"}}},
          MakeEffect<Stiffening>};
}

}  // namespace hydro::model
