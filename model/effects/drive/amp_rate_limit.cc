// amp.rate_limit: the motor's torque follows its command no faster than `rate`: |T'| <= rate. What moves is
// the voltage that acts, u' = rate/k_1 sgn(v - u), so T = k_1 u stays within T_pmax as ever. It comes after
// amp.delay and before amp.lag. One state, u. One switch: 0, u is the command; +1 and -1, u moves towards it
// in that direction.

#include <cmath>

#include "model/effects/effect.h"

namespace hydro::model {

namespace {

class RateLimit : public EffectOf<RateLimit> {
 public:
  int states() const override { return 1; }
  int switches() const override { return 1; }
  std::vector<std::string> StateNames() const override { return {"limited_voltage"}; }
  void Scales(const StateSizes& of, double* scale) const override { scale[0] = of.voltage; }

  template <class T>
  void OwnProperties(Terms<T>& x) const {
    x.voltage_asked = x.voltage;
    if (Side(x) == 0) return;
    x.voltage = x.state[first_state()];
    x.torque = LimitedTorque(*x.parameters, x.voltage);
  }

  template <class T>
  void OwnStates(Terms<T>& x, T* rate) const {
    rate[first_state()] = Side(x) * x.own[0] / x.parameters->k_1;
  }

  template <class T>
  void OwnMargins(const Terms<T>& x, T* margin) const {
    using std::abs;
    const double side = Side(x);
    margin[kFirstEffectSwitch + first_switch()] =
        side == 0 ? T(Near(x) - abs(Behind(x))) : T(side * Behind(x));
  }

  // A command that changes while u is moving towards it may turn u back.
  template <class T>
  void OwnCross(int /*which*/, const Terms<T>& x, T* state, Mode* mode) const {
    using std::abs;
    const T behind = Behind(x);
    int8_t& position = mode->effects[first_switch()];
    if (position != 0 && abs(behind) <= Near(x)) {
      position = 0;
    } else {
      position = behind > T(0.0) ? 1 : -1;
    }
    if (position == 0) state[first_state()] = x.voltage_asked;
  }

 private:
  template <class T>
  double Side(const Terms<T>& x) const {
    const int position = x.mode->effects[first_switch()];
    return position == 0 ? 0 : (position > 0 ? 1 : -1);
  }
  template <class T>
  T Behind(const Terms<T>& x) const {
    return x.voltage_asked - x.state[first_state()];
  }
  // The rounding error of a command that has been reached.
  template <class T>
  static T Near(const Terms<T>& x) {
    return 1e-6 * x.parameters->T_pmax / x.parameters->k_1;
  }
};

[[maybe_unused]] const bool kAmpRateLimitAdded =
    AddToCatalogue({.info = {.id = "amp.rate_limit",
                             .summary = "the motor torque follows the voltage no faster than a rate",
                             .equation = "abs(dT/dt) <= rate",
                             .confused_with = "amp.lag, amp.delay",
                             .parameters = {{.name = "rate",
                                             .unit = "in-lbf/s",
                                             .min_allowed = false,
                                             .meaning = "largest rate of the motor torque",
                                             .starts = {0.003, 0.03},
                                             .scale = Scale::kTorqueRate,
                                             .example = 8000}},
                             .after = "amp.delay",
                             // The time at which it reaches a command is known only to within a sample.
                             .unseen_by_balances = true,
                             .on_request = true},
                    .make = MakeEffect<RateLimit>});

}  // namespace

}  // namespace hydro::model
