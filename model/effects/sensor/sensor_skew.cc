// sensor.skew: one channel is recorded late: it reads what it should have read `delay` earlier or, before the
// start, the first value. The equations do not change.

#include "model/effects/effect.h"
#include "model/effects/sensor/sensor_signal.h"

namespace hydro::model {

namespace {

class Skew : public EffectOf<Skew> {
 public:
  Skew(Signal signal, double delay) : signal_(signal), delay_(delay) {}

  bool reads_late() const override { return true; }
  double reach() const override { return delay_; }

  template <class T>
  T OwnLateness(const T* own) const {
    return own[0];
  }
  template <class T>
  void OwnReplace(const MeasurementOf<T>& then, MeasurementOf<T>* measured) const {
    ChangeSignal(signal_, then, measured, [](const T& value) { return value; });
  }

 private:
  Signal signal_;
  double delay_;
};

[[maybe_unused]] const bool kSensorSkewAdded = AddToCatalogue(
    {.info = {.id = "sensor.skew",
              .summary = "one channel is recorded late",
              .equation = "one channel is late by delay",
              .confused_with = "amp.delay",
              .parameters = {{.name = "delay",
                              .unit = "s",
                              .meaning = "by which the channel is late",
                              .starts = {0, 10},
                              .scale = Scale::kSample,
                              .role = Role::kTime,
                              .example = 0.001},
                             {.name = "signal",
                              .unit = "name",
                              .meaning = "the channel that is late",
                              .names = SignalNames(),
                              .role = Role::kChannel}}},
     .make = [](const EffectDescription& description) -> std::unique_ptr<Effect> {
       return std::make_unique<Skew>(SignalOf(description), description.parameters.at("delay"));
     }});

}  // namespace

}  // namespace hydro::model
