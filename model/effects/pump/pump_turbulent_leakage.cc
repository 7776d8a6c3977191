// pump.turbulent_leakage: cross-port flow + k sgn(dp) sqrt(abs(dp)), an orifice beside the laminar leakage
// c_I. The root's slope at dp = 0 is infinite, but any orifice is laminar there. The root is therefore
// replaced by dp/(dp^2 + w^2)^(1/4) with w = 2e-4 T_pmax/D, which is 1 psi for Table 1: 0.25 % below the root
// at 10 psi, 0.0025 % at 100 psi.

#include <cmath>

#include "model/effects/effect.h"

namespace hydro::model {

namespace {

class TurbulentLeakage : public EffectOf<TurbulentLeakage> {
 public:
  template <class T>
  void OwnTorquesAndFlows(Terms<T>& x) const {
    using std::sqrt;
    const T dp = x.pump_p2 - x.pump_p1;
    const T width = kLaminarPart * x.parameters->T_pmax / x.parameters->D;
    x.cross_flow += x.own[0] * dp / sqrt(sqrt(dp * dp + width * width));
  }

 private:
  static constexpr double kLaminarPart = 2e-4;  // of T_pmax/D
};

[[maybe_unused]] const bool kPumpTurbulentLeakageAdded = AddToCatalogue(
    {.info = {.id = "pump.turbulent_leakage",
              .summary = "leakage across the pump's ports as through an orifice",
              .equation = "cross-port flow + k sgn(dp) sqrt(abs(dp))",
              .confused_with = "parameter c_I",
              .parameters =
                  {{.name = "k", .unit = "in^3/s/psi^.5", .meaning = "flow at dp = 1", .example = 0.001}},
              .needs_oil = true},
     .make = MakeEffect<TurbulentLeakage>});

}  // namespace

}  // namespace hydro::model
