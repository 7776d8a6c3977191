// fluid.warming: viscous friction and leakage drift as the oil warms: b exp(-rate t), c_E and c_I exp(+rate
// t).
#include <ceres/jet.h>

#include <cmath>

#include "model/effects/effect.h"

namespace hydro {

namespace {

class Warming : public EffectOf<Warming> {
 public:
  explicit Warming(double rate) : rate_(rate) {}

  template <class T>
  void OwnProperties(Terms<T>& x) const {
    const double thinner = std::exp(rate_ * x.time);
    x.b /= thinner;
    x.c_E *= thinner;
    x.c_I *= thinner;
  }

 private:
  double rate_;
};

}  // namespace

CatalogueEntry FluidWarming();
CatalogueEntry FluidWarming() {
  return {{"fluid.warming",
           "viscous friction and leakage drift as the oil warms",
           "viscous friction and leakage drift as the oil warms: b exp(-rate t), c_E and c_I exp(+rate t)",
           "parameter b",
           {{"rate", "1/s", -kUnbounded, kUnbounded, true, "relative change per second"}}},
          [](const EffectDescription& description, const Parameters&) -> std::unique_ptr<Effect> {
            return std::make_unique<Warming>(description.parameters.at("rate"));
          }};
}

}  // namespace hydro
