// sensor.pressure_drift: the measured p1, p2 are shifted by rate t, with t from the run's first sample on.
// The equations do not change.

#include "model/effects/effect.h"

namespace hydro::model {

namespace {

class PressureDrift : public EffectOf<PressureDrift> {
 public:
  template <class T>
  void OwnSense(const SenseTerms<T>& at, MeasurementOf<T>* measured) const {
    measured->p1 += at.own[0] * at.time;
    measured->p2 += at.own[1] * at.time;
  }
};

[[maybe_unused]] const bool kSensorPressureDriftAdded =
    AddToCatalogue({.info = {.id = "sensor.pressure_drift",
                             .summary = "the pressure transducers drift",
                             .equation = "measured p1, p2 shifted by rate t",
                             .confused_with = "fluid.warming",
                             .parameters = {{.name = "p1",
                                             .unit = "psi/s",
                                             .min = -kUnbounded,
                                             .meaning = "rate at which p1's reading rises",
                                             .example = 20},
                                            {.name = "p2",
                                             .unit = "psi/s",
                                             .min = -kUnbounded,
                                             .meaning = "rate at which p2's reading rises",
                                             .example = -30}}},
                    .make = MakeEffect<PressureDrift>});

}  // namespace

}  // namespace hydro::model
