// sensor.pressure_gain: the measured pressures are scaled by 1 + gain. The equations do not change.

#include "model/effects/effect.h"

namespace hydro::model {

namespace {

class PressureGain : public EffectOf<PressureGain> {
 public:
  template <class T>
  void OwnSense(const SenseTerms<T>& at, MeasurementOf<T>* measured) const {
    measured->p1 *= 1.0 + at.own[0];
    measured->p2 *= 1.0 + at.own[0];
  }
};

[[maybe_unused]] const bool kSensorPressureGainAdded =
    AddToCatalogue({.info = {.id = "sensor.pressure_gain",
                             .summary = "the pressure transducers' scale is off",
                             .equation = "measured pressures scaled by 1 + gain",
                             .confused_with = "parameters k_1, k_2",
                             .parameters = {{.name = "gain",
                                             .unit = "1",
                                             .min = -1,
                                             .min_allowed = false,
                                             .meaning = "relative error of the scale",
                                             .example = 0.05}}},
                    .make = MakeEffect<PressureGain>});

}  // namespace

}  // namespace hydro::model
