// load.spring: a spring at the motor's shaft, stiffness (theta - rest) against forward rotation. Behind gear.backlash it is theta
// of the load.

#include "model/effects/effect.h"

namespace hydro::model {

namespace {

class ShaftSpring : public EffectOf<ShaftSpring> {
 public:
  template <class T>
  void OwnTorquesAndFlows(Terms<T>& x) const {
    x.shaft_load += Torque(x);
  }

  void AddPower(const Terms<double>& x, const double* /*rate*/, Power* power) const override {
    const double stored = Torque(x) * x.motor_speed;
    power->viscous -= stored;  // which contains it as part of the load
    power->effects_stored += stored;
  }

 private:
  template <class T>
  static T Torque(const Terms<T>& x) {
    return x.own[0] * (x.shaft_angle - x.own[1]);
  }
};

[[maybe_unused]] const bool kAdded = AddToCatalogue(
    {.info = {.id = "load.spring",
              .summary = "a spring turns the motor's shaft back",
              .equation = "T -= stiffness (theta - rest)",
              .confused_with = "load.gravity over a small angle; the oil's own stiffness, clamped",
              .parameters = {{.name = "stiffness",
                              .unit = "in-lbf/rad",
                              .meaning = "torque per angle",
                              .example = 0.05},
                             {.name = "rest",
                              .unit = "rad",
                              .min = -kUnbounded,
                              .meaning = "theta at which the spring is slack",
                              .example = 1}},
              // Clamped, the oil is such a spring.
              .on_request = true},
     .make = MakeEffect<ShaftSpring>});

}  // namespace

}  // namespace hydro::model
