// amp.deadband: the amplifier ignores commands within +/- `width`, and acts on the excess of larger ones:
// v -/+ width. It comes after amp.delay and before amp.lag. The voltage is held between commands, so the
// corner is no event.

#include <algorithm>

#include "model/effects/effect.h"

namespace hydro::model {

namespace {

class Deadband : public EffectOf<Deadband> {
 public:
  template <class T>
  void OwnProperties(Terms<T>& x) const {
    x.voltage -= std::clamp<T>(x.voltage, -x.own[0], x.own[0]);
    x.torque = LimitedTorque(*x.parameters, x.voltage);
  }
};

[[maybe_unused]] const bool kAmpDeadbandAdded =
    AddToCatalogue({.info = {.id = "amp.deadband",
                             .summary = "the amplifier ignores small commands",
                             .equation = "v becomes v -/+ width, 0 within +/- width",
                             .confused_with = "parameter T_s, pump.stribeck",
                             .parameters = {{.name = "width",
                                             .unit = "V",
                                             .meaning = "command up to which nothing happens",
                                             .example = 0.2}},
                             .after = "amp.delay",
                             // With commands that never come to rest on one side of the band, it looks like a
                             // larger T_s.
                             .on_request = true},
                    .make = MakeEffect<Deadband>});

}  // namespace

}  // namespace hydro::model
