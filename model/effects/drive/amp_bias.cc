// amp.bias: a constant torque on the pump, from an amplifier whose zero is off or from the load. It acts
// whatever the command is: neither the limit T_pmax nor a lag of the amplifier changes it.

#include "model/effects/effect.h"

namespace hydro::model {

namespace {

class Bias : public EffectOf<Bias> {
 public:
  template <class T>
  void OwnTorquesAndFlows(Terms<T>& x) const {
    x.load -= x.own[0];
  }
};

[[maybe_unused]] const bool kAmpBiasAdded =
    AddToCatalogue({.info = {.id = "amp.bias",
                             .summary = "a constant torque of the amplifier or the load",
                             .equation = "T + bias",
                             .confused_with = "pump.friction_asymmetry (coulomb) on one-way motion",
                             .parameters = {{.name = "bias",
                                             .unit = "in-lbf",
                                             .min = -kUnbounded,
                                             .meaning = "torque that is always there, forward positive",
                                             .example = 0.6}}},
                    .make = MakeEffect<Bias>});

}  // namespace

}  // namespace hydro::model
