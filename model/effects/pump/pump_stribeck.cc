// pump.stribeck: static friction above kinetic. T_s becomes T_s (1 + static_excess exp(-(theta'/speed)^2)),
// and T_s (1 + static_excess) at rest. Each slip mode is smooth: its friction falls with speed but never
// changes sign. Form after Armstrong-Helouvry, Dupont and Canudas de Wit 1994.

#include <cmath>

#include "model/effects/effect.h"

namespace hydro::model {

namespace {

class Stribeck : public EffectOf<Stribeck> {
 public:
  template <class T>
  void OwnTorquesAndFlows(Terms<T>& x) const {
    using std::exp;
    const T& static_excess = x.own[0];
    const T& speed = x.own[1];
    const T ratio = x.motor_speed / speed;
    x.coulomb += x.T_s * static_excess * exp(-ratio * ratio);
    x.breakaway += x.T_s * static_excess;
  }
};

[[maybe_unused]] const bool kPumpStribeckAdded =
    AddToCatalogue({.info = {.id = "pump.stribeck",
                             .summary = "static friction above kinetic",
                             .equation = "T_s becomes T_s (1 + static_excess exp(-(abs(theta')/speed)^2)), "
                                         "T_s (1 + static_excess) at rest",
                             .confused_with = "pump.friction_asymmetry",
                             .parameters = {{.name = "static_excess",
                                             .unit = "1",
                                             .meaning = "static friction over kinetic, less 1",
                                             .example = 0.5},
                                            {.name = "speed",
                                             .unit = "rad/s",
                                             .min_allowed = false,
                                             .meaning = "motor speed over which the excess falls off",
                                             .starts = {0.005, 0.03, 0.15},
                                             .scale = Scale::kSpeed,
                                             .example = 3}}},
                    .make = MakeEffect<Stribeck>});

}  // namespace

}  // namespace hydro::model
