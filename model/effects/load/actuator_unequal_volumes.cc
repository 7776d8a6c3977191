// actuator.unequal_volumes: at mid-stroke side 1 has V_ms (1 - difference) and side 2 V_ms (1 + difference),
// for example because a cylinder's rod, or the longer line, is on one side.

#include "model/effects/effect.h"

namespace hydro::model {

namespace {

class UnequalVolumes : public EffectOf<UnequalVolumes> {
 public:
  template <class T>
  void OwnProperties(Terms<T>& x) const {
    const T more = x.own[0] * x.parameters->V_ms;
    x.V_1 -= more;
    x.V_2 += more;
  }
};

[[maybe_unused]] const bool kActuatorUnequalVolumesAdded = AddToCatalogue(
    {.info = {.id = "actuator.unequal_volumes",
              .summary = "the two sides have unequal volumes at mid-stroke",
              .equation = "V_ms becomes V_ms (1 - difference) on side 1, V_ms (1 + difference) on side 2",
              .confused_with = "parameters V_ms and beta, fluid.entrained_air",
              .parameters = {{.name = "difference",
                              .unit = "1",
                              .min = -0.95,
                              .max = 0.95,
                              .meaning = "(V_2 - V_1)/(V_1 + V_2) at mid-stroke",
                              .sides = &Parameters::V_ms,
                              .example = 0.3}},
              .needs_oil = true,
              // An arm whose zero is not at mid-stroke looks the same.
              .on_request = true},
     .make = MakeEffect<UnequalVolumes>});

}  // namespace

}  // namespace hydro::model
