// sensor.pressure_offset: the measured p1, p2 are shifted. The equations do not change.

#include "model/effects/effect.h"

namespace hydro::model {

namespace {

class PressureOffset : public EffectOf<PressureOffset> {
 public:
  template <class T>
  void OwnSense(const SenseTerms<T>& at, MeasurementOf<T>* measured) const {
    measured->p1 += at.own[0];
    measured->p2 += at.own[1];
  }
};

}  // namespace

CatalogueEntry SensorPressureOffset();
CatalogueEntry SensorPressureOffset() {
  return {{"sensor.pressure_offset",
           "the pressure transducers read too much or too little",
           "measured p1, p2 shifted",
           "parameter p3",
           {{"p1", "psi", -kUnbounded, kUnbounded, true, "what p1's transducer reads too much"},
            {"p2", "psi", -kUnbounded, kUnbounded, true, "what p2's transducer reads too much"}}},
          MakeEffect<PressureOffset>};
}

}  // namespace hydro::model
