// sensor.sign: one measured channel is inverted. The equations do not change.

#include "model/effects/effect.h"
#include "model/effects/sensor/sensor_signal.h"

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

[[maybe_unused]] const bool kSensorSignAdded =
    AddToCatalogue({.info = {.id = "sensor.sign",
                             .summary = "one channel has the wrong sign",
                             .equation = "one channel is inverted",
                             .confused_with = "nothing",
                             .parameters = {{.name = "signal",
                                             .unit = "name",
                                             .meaning = "the channel that is inverted",
                                             .names = SignalNames(),
                                             .role = Role::kChannel}},
                             // Signs are settled before balances are formed, which would otherwise have the
                             // wrong sign.
                             .unseen_by_balances = true},
                    .make = [](const EffectDescription& description) -> std::unique_ptr<Effect> {
                      return std::make_unique<Sign>(SignalOf(description));
                    }});

}  // namespace

}  // namespace hydro::model
