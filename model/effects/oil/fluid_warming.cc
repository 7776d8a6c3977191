// fluid.warming: as the oil warms, viscous friction falls and leakage grows: b exp(-rate t), c_E and c_I
// exp(+rate t).

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

[[maybe_unused]] const bool kFluidWarmingAdded = AddToCatalogue(
    {.info =
         {.id = "fluid.warming",
          .summary = "viscous friction and leakage drift as the oil warms",
          .equation =
              "viscous friction and leakage drift as the oil warms: b exp(-rate t), c_E and c_I exp(+rate t)",
          .confused_with = "parameter b",
          .parameters = {{.name = "rate",
                          .unit = "1/s",
                          .min = -kUnbounded,
                          .meaning = "relative change per second",
                          .example = 2}}},
     .make = MakeEffect<Warming>});

}  // namespace

}  // namespace hydro::model
