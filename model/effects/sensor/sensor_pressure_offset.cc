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

[[maybe_unused]] const bool kSensorPressureOffsetAdded =
    AddToCatalogue({.info = {.id = "sensor.pressure_offset",
                             .summary = "the pressure transducers read too much or too little",
                             .equation = "measured p1, p2 shifted",
                             .confused_with = "parameter p3",
                             .parameters = {{.name = "p1",
                                             .unit = "psi",
                                             .min = -kUnbounded,
                                             .meaning = "what p1's transducer reads too much",
                                             .example = 3},
                                            {.name = "p2",
                                             .unit = "psi",
                                             .min = -kUnbounded,
                                             .meaning = "what p2's transducer reads too much",
                                             .example = -2}}},
                    .make = MakeEffect<PressureOffset>});

}  // namespace

}  // namespace hydro::model
