// amp.delay: T(t) = k_1 v(t - delay). The voltage is held between commands, so a delayed voltage changes at
// times that are known in advance.

#include <cstddef>
#include <vector>

#include "model/effects/effect.h"

namespace hydro::model {

namespace {

class Delay : public EffectOf<Delay> {
 public:
  explicit Delay(double delay) : delay_(delay) {}

  template <class T>
  void OwnProperties(Terms<T>& x) const {
    if (x.voltage_acts) return;
    x.voltage = T(voltage_);
    x.torque = LimitedTorque(*x.parameters, x.voltage);
  }

  template <class T>
  T OwnStopShift(const T* own) const {
    T shift = own[0];
    shift.a = 0;
    return shift;
  }

  void Command(double time, double voltage) override {
    if (first_ == waiting_.size()) {
      waiting_.clear();
      first_ = 0;
    }
    waiting_.push_back({time + delay_, voltage});
  }
  double NextStop(double /*time*/) const override {
    return first_ < waiting_.size() ? waiting_[first_].time : kUnbounded;
  }
  void PassStop(double time) override {
    while (first_ < waiting_.size() && waiting_[first_].time <= time) voltage_ = waiting_[first_++].voltage;
    if (first_ > 1000) {
      waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(first_));
      first_ = 0;
    }
  }

 private:
  struct Delayed {
    double time;
    double voltage;
  };
  double delay_;
  double voltage_ = 0;
  std::vector<Delayed> waiting_;
  size_t first_ = 0;
};

[[maybe_unused]] const bool kAmpDelayAdded =
    AddToCatalogue({.info = {.id = "amp.delay",
                             .summary = "the motor torque follows the voltage with a delay",
                             .equation = "T(t) = k_1 v(t - delay)",
                             .confused_with = "amp.lag, sensor.skew",
                             .parameters = {{.name = "delay",
                                             .unit = "s",
                                             .meaning = "from a change of the voltage to that of the torque",
                                             .starts = {2},
                                             .scale = Scale::kSample,
                                             .role = Role::kTime,
                                             .example = 0.002}}},
                    .make = [](const EffectDescription& description) -> std::unique_ptr<Effect> {
                      return std::make_unique<Delay>(description.parameters.at("delay"));
                    }});

}  // namespace

}  // namespace hydro::model
