// motor.cogging: T -= amplitude sin(periods theta + phase), a conservative torque of the motor's magnets. It
// acts on the pump at rest too, where friction holds it.

#include <cmath>
#include <numbers>

#include "model/effects/effect.h"

namespace hydro::model {

namespace {

class Cogging : public EffectOf<Cogging> {
 public:
  template <class T>
  void OwnTorquesAndFlows(Terms<T>& x) const {
    x.load += Torque(x);
  }

  void AddPower(const Terms<double>& x, const double* /*rate*/, Power* power) const override {
    const double stored = Torque(x) * x.motor_speed;
    power->viscous -= stored;  // where it is as part of the load
    power->effects_stored += stored;
  }

 private:
  template <class T>
  static T Torque(const Terms<T>& x) {
    using std::sin;
    return x.own[0] * sin(x.own[1] * x.motor_angle + x.own[2]);
  }
};

}  // namespace

CatalogueEntry MotorCogging();
CatalogueEntry MotorCogging() {
  return {
      {"motor.cogging",
       "the motor's magnets pull towards fixed angles",
       "T -= amplitude sin(periods theta + phase)",
       "pump.flow_ripple",
       {{"amplitude", "in-lbf", -kUnbounded, kUnbounded, true,
         "largest cogging torque; negative: half a period on"},
        {"periods", "1/rev", 0, kUnbounded, false, "periods in one revolution", false, {}, PeriodsTried()},
        {"phase",
         "rad",
         -kUnbounded,
         kUnbounded,
         true,
         "phase at theta = 0",
         false,
         {},
         {0, std::numbers::pi / 2}}}},
      MakeEffect<Cogging>};
}

}  // namespace hydro::model
