// sensor.pressure_offset: the measured p1, p2 are shifted. The equations do not change.
#include <ceres/jet.h>

#include "model/effects/effect.h"

namespace hydro {

namespace {

class PressureOffset : public EffectOf<PressureOffset> {
 public:
  PressureOffset(double p1, double p2) : p1_(p1), p2_(p2) {}

  template <class T>
  void OwnSense(const T* /*state*/, MeasurementOf<T>* measured) const {
    measured->p1 += p1_;
    measured->p2 += p2_;
  }

 private:
  double p1_;
  double p2_;
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
          [](const EffectDescription& description, const Parameters&) -> std::unique_ptr<Effect> {
            return std::make_unique<PressureOffset>(description.parameters.at("p1"),
                                                    description.parameters.at("p2"));
          }};
}

}  // namespace hydro
