// fluid.warming: viscous friction and leakage drift as the oil warms: b exp(-rate t), c_E and c_I exp(+rate
// t).

#include <cmath>

#include "model/effects/effect.h"

namespace hydro::model {

namespace {

class Warming : public EffectOf<Warming> {
 public:
  template <class T>
  void OwnProperties(Terms<T>& x) const {
    using std::exp;
    const T thinner = exp(x.own[0] * x.time);
    x.b /= thinner;
    x.c_E *= thinner;
    x.c_I *= thinner;
  }
};

}  // namespace

CatalogueEntry FluidWarming();
CatalogueEntry FluidWarming() {
  return {{"fluid.warming",
           "viscous friction and leakage drift as the oil warms",
           "viscous friction and leakage drift as the oil warms: b exp(-rate t), c_E and c_I exp(+rate t)",
           "parameter b",
           {{"rate", "1/s", -kUnbounded, kUnbounded, true, "relative change per second"}}},
          MakeEffect<Warming>};
}

}  // namespace hydro::model
