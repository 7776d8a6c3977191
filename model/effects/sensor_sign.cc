// sensor.sign: one channel is inverted in what is measured. The equations do not change.

#include "model/effects/effect.h"
#include "model/effects/sensor_signal.h"

namespace hydro::model {

namespace {

class Sign : public EffectOf<Sign> {
 public:
  explicit Sign(Signal signal) : signal_(signal) {}

  template <class T>
  void OwnSense(const SenseTerms<T>& /*at*/, MeasurementOf<T>* measured) const {
    ChangeSignal(signal_, *measured, measured, [](const T& value) { return T(-value); });
  }

 private:
  Signal signal_;
};

}  // namespace

CatalogueEntry SensorSign();
CatalogueEntry SensorSign() {
  return {{"sensor.sign",
           "one channel has the wrong sign",
           "one channel is inverted",
           "nothing",
           {{"signal", "name", 0, 0, true, "the channel that is inverted", true, SignalNames()}}},
          [](const EffectDescription& description) -> std::unique_ptr<Effect> {
            return std::make_unique<Sign>(SignalOf(description));
          }};
}

}  // namespace hydro::model
