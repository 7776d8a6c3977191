// fluid.viscosity: warm oil is thinner. With the oil's temperature T: b exp(-k (T - T_0)), c_E and c_I
// exp(+k (T - T_0)); the reference T_0 is 40 degC, as for the viscosity grades of ISO 3448. Over some tens of
// kelvin the logarithm of the viscosity of a mineral oil falls linearly (Walther's equation, ASTM D341, is
// nearly linear there). The temperature is the recorded one, or 20 degC if a run has none.

#include <cmath>

#include "model/effects/effect.h"

namespace hydro::model {

namespace {

constexpr double kReference = 40;  // degC

class Viscosity : public EffectOf<Viscosity> {
 public:
  template <class T>
  void OwnProperties(Terms<T>& x) const {
    using std::exp;
    const T thinner = exp(x.own[0] * (x.around.temperature - kReference));
    x.b /= thinner;
    x.c_E *= thinner;
    x.c_I *= thinner;
  }
};

[[maybe_unused]] const bool kFluidViscosityAdded = AddToCatalogue(
    {.info =
         {.id = "fluid.viscosity",
          .summary = "viscous friction and leakage follow the oil's temperature",
          .equation =
              "b exp(-k (T - T_0)), c_E and c_I exp(+k (T - T_0)), with the oil's temperature T and T_0 = "
              "40 degC",
          .confused_with = "fluid.warming, parameter b",
          .parameters = {{.name = "k",
                          .unit = "1/K",
                          .min = -kUnbounded,
                          .meaning = "relative change per kelvin",
                          .example = 0.03}},
          .needs_temperature = true,
          .on_request = true},
     .make = MakeEffect<Viscosity>});

}  // namespace

}  // namespace hydro::model
