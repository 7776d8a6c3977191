// load.spring: a spring that pulls the load back to `rest`. With a hydraulic arm it acts on the arm: arm
// torque - stiffness (alpha - rest); a clamped or driven shaft does not feel it, as whatever holds the shaft
// also holds the spring. On a bare motor, whose bypass is open and whose arm is not free, it acts on the
// motor's shaft: T - stiffness (theta - rest), where with gear.backlash theta is the load's.

#include "model/effects/effect.h"

namespace hydro::model {

namespace {

class LoadSpring : public EffectOf<LoadSpring> {
 public:
  template <class T>
  void OwnTorquesAndFlows(Terms<T>& x) const {
    if (x.arm_free) {
      x.arm_torque -= Torque(x, x.arm_angle);
    } else if (x.bypass) {
      x.shaft_load += Torque(x, x.shaft_angle);
    }
  }

  void AddPower(const Terms<double>& x, const double* /*rate*/, Power* power) const override {
    if (x.arm_free) {
      power->effects_stored += Torque(x, x.arm_angle) * x.arm_speed;
    } else if (x.bypass) {
      const double stored = Torque(x, x.shaft_angle) * x.motor_speed;
      power->viscous -= stored;  // which contains it as part of the load
      power->effects_stored += stored;
    }
  }

 private:
  template <class T>
  static T Torque(const Terms<T>& x, const T& angle) {
    return x.own[0] * (angle - x.own[1]);
  }
};

[[maybe_unused]] const bool kLoadSpringAdded = AddToCatalogue(
    {.info = {.id = "load.spring",
              .summary = "a spring pulls the load back",
              .equation =
                  "arm torque - stiffness (alpha - rest); of a bare motor T - stiffness (theta - rest)",
              .confused_with = "parameter mgl, load.gravity over a small angle",
              // A bare motor has no arm whose coordinate could be a length, so the units are one.
              .parameters = {{.name = "stiffness",
                              .unit = "in-lbf/rad",
                              .meaning = "torque per angle",
                              .arm = -2,
                              .example = 500},
                             {.name = "rest",
                              .unit = "rad",
                              .min = -kUnbounded,
                              .meaning = "alpha, or theta, at which the spring is slack",
                              .arm = 1,
                              .example = 0.1}},
              // With a clamped shaft, the oil is such a spring of the motor.
              .on_request = true},
     .make = MakeEffect<LoadSpring>});

}  // namespace

}  // namespace hydro::model
