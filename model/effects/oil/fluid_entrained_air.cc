// fluid.entrained_air: free air is `air_fraction` of the fluid's volume at atmospheric pressure and is
// compressed polytropically, V_air proportional to p_abs^(-1/n) with n = 1.4. On each side, with its own
// pressure,
//   1/beta_eff = 1/beta + air_fraction/(n p_abs) (p_atm/p_abs)^(1/n),  p_abs = p + p_atm:
// the model's pressures count from atmospheric pressure. After Gholizadeh et al. and Merritt.

#include <cmath>

#include "model/effects/effect.h"

namespace hydro::model {

namespace {

class EntrainedAir : public EffectOf<EntrainedAir> {
 public:
  // Applied once every property of the liquid is known.
  template <class T>
  void OwnTorquesAndFlows(Terms<T>& x) const {
    const double atmosphere = x.atmosphere;
    x.beta_1 = x.beta_1 / (1.0 + x.beta_1 * x.own[0] * Compressibility(x.p1, atmosphere));
    x.beta_2 = x.beta_2 / (1.0 + x.beta_2 * x.own[0] * Compressibility(x.p2, atmosphere));
  }

 private:
  static constexpr double kExponent = 1.4;

  // For air that has volume 1 at atmospheric pressure. Below p = 0 the absolute pressure approaches 0
  // smoothly and stays above it, so a vacuum is soft but not an error; at p = 100 psi this adds 1e-5.
  template <class T>
  static T Compressibility(const T& p, double atmosphere) {
    using std::pow;
    using std::sqrt;
    const T absolute = p + atmosphere;
    const double least = 0.05 * atmosphere;
    const T above_0 = 0.5 * (absolute + sqrt(absolute * absolute + least * least));
    return pow(atmosphere / above_0, 1 / kExponent) / (kExponent * above_0);
  }
};

[[maybe_unused]] const bool kFluidEntrainedAirAdded = AddToCatalogue(
    {.info = {.id = "fluid.entrained_air",
              .summary = "air bubbles make the fluid soft at low pressure",
              .equation =
                  "1/beta_eff = 1/beta + compressibility of air that is `air_fraction` of the volume at "
                  "atmospheric "
                  "pressure, compressed polytropically",
              .confused_with = "parameter beta, fluid.stiffening",
              // The less air there is, the more each small amount of it matters: a fit that starts from none
              // does not find 1 part in 500.
              .parameters = {{.name = "air_fraction",
                              .unit = "1",
                              .max = 1,
                              .meaning = "volume of the air at atmospheric pressure over the fluid's",
                              .starts = {0, 5e-4, 5e-3},
                              .example = 0.02}},
              .needs_oil = true},
     .make = MakeEffect<EntrainedAir>});

}  // namespace

}  // namespace hydro::model
