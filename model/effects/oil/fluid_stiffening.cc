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

[[maybe_unused]] const bool kFluidStiffeningAdded = AddToCatalogue(
    {.info = {.id = "fluid.stiffening",
              .summary = "the bulk modulus grows with pressure",
              .equation = "beta + slope p",
              .confused_with = "fluid.entrained_air",
              .parameters =
                  {{.name = "slope", .unit = "1", .meaning = "bulk modulus per pressure", .example = 20}},
              .needs_oil = true},
     .make = MakeEffect<Stiffening>});

}  // namespace

}  // namespace hydro::model
