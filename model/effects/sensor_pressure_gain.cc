// sensor.pressure_gain: the measured pressures are scaled by 1 + gain. The equations do not change.
#include <ceres/jet.h>

#include "model/effects/effect.h"

namespace hydro {

namespace {

class PressureGain : public EffectOf<PressureGain> {
 public:
  explicit PressureGain(double gain) : gain_(gain) {}

  template <class T>
  void OwnSense(const T* /*state*/, MeasurementOf<T>* measured) const {
    measured->p1 *= 1 + gain_;
    measured->p2 *= 1 + gain_;
  }

 private:
  double gain_;
};

}  // namespace

CatalogueEntry SensorPressureGain();
CatalogueEntry SensorPressureGain() {
  return {{"sensor.pressure_gain",
           "the pressure transducers' scale is off",
           "measured pressures scaled by 1 + gain",
           "parameters k_1, k_2",
           {{"gain", "1", -1, kUnbounded, false, "relative error of the scale"}}},
          [](const EffectDescription& description, const Parameters&) -> std::unique_ptr<Effect> {
            return std::make_unique<PressureGain>(description.parameters.at("gain"));
          }};
}

}  // namespace hydro
