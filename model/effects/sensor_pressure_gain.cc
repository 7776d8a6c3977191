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

}  // namespace

CatalogueEntry SensorPressureGain();
CatalogueEntry SensorPressureGain() {
  return {{"sensor.pressure_gain",
           "the pressure transducers' scale is off",
           "measured pressures scaled by 1 + gain",
           "parameters k_1, k_2",
           {{"gain", "1", -1, kUnbounded, false, "relative error of the scale"}}},
          MakeEffect<PressureGain>};
}

}  // namespace hydro::model
