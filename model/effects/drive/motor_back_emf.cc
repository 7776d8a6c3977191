// motor.back_emf: a motor driven by a voltage, without a current loop: tau dT/dt + T = k_1 (v - k_e theta'),
// limited to T_pmax in magnitude. With the winding's resistance R, inductance L and torque constant k_t, k_1
// = k_t/R and tau = L/R; tau = 0 leaves the inductance out. One state, T. One switch: 0, T is within the
// limit; +1 and -1, T_p is at that limit. amp.lag cannot be combined with it.

#include <cmath>

#include "model/effects/effect.h"

namespace hydro::model {

namespace {

class BackEmf : public EffectOf<BackEmf> {
 public:
  int states() const override { return 1; }
  int switches() const override { return 1; }
  std::vector<std::string> StateNames() const override { return {"winding_torque"}; }
  void Scales(const StateSizes& of, double* scale) const override { scale[0] = of.torque; }

  template <class T>
  void OwnProperties(Terms<T>& x) const {
    const int limit = x.mode->effects[first_switch()];
    x.torque = limit == 0 ? Torque(x) : T(static_cast<double>(limit) * x.parameters->T_pmax);
  }

  template <class T>
  void OwnStates(Terms<T>& x, T* rate) const {
    rate[first_state()] = HasInductance(x) ? T((Settled(x) - x.state[first_state()]) / x.own[1]) : T(0.0);
  }

  template <class T>
  void OwnMargins(const Terms<T>& x, T* margin) const {
    using std::abs;
    const int limit = x.mode->effects[first_switch()];
    const T torque = Torque(x);
    const T& T_pmax = x.parameters->T_pmax;
    margin[kFirstEffectSwitch + first_switch()] =
        limit == 0 ? T(T_pmax - abs(torque)) : T(static_cast<double>(limit) * torque - T_pmax);
  }

  template <class T>
  void OwnCross(int /*which*/, const Terms<T>& x, T* /*state*/, Mode* mode) const {
    int8_t& limit = mode->effects[first_switch()];
    limit = limit != 0 ? 0 : (Torque(x) > T(0.0) ? 1 : -1);
  }

 private:
  template <class T>
  static bool HasInductance(const Terms<T>& x) {
    return x.own[1] > T(0.0);
  }
  template <class T>
  static T Settled(const Terms<T>& x) {
    return x.parameters->k_1 * (x.voltage - x.own[0] * x.motor_speed);
  }
  template <class T>
  T Torque(const Terms<T>& x) const {
    return HasInductance(x) ? x.state[first_state()] : Settled(x);
  }
};

[[maybe_unused]] const bool kMotorBackEmfAdded =
    AddToCatalogue({.info = {.id = "motor.back_emf",
                             .summary = "the motor is driven by a voltage, not by a current",
                             .equation = "tau dT/dt + T = k_1 (v - k_e theta')",
                             .confused_with = "parameter b, amp.lag, motor.speed_torque_limit",
                             .parameters = {{.name = "k_e",
                                             .unit = "V s/rad",
                                             .meaning = "voltage that the turning motor makes",
                                             .example = 0.02},
                                            {.name = "tau",
                                             .unit = "s",
                                             .meaning = "L/R of the winding; 0: no inductance",
                                             .starts = {2},
                                             .scale = Scale::kSample,
                                             .role = Role::kTime,
                                             .example = 0.002,
                                             .optional = true,
                                             .standard = 0.0}},
                             // Without inductance, k_1 k_e adds to b.
                             .on_request = true},
                    .make = MakeEffect<BackEmf>});

}  // namespace

}  // namespace hydro::model
