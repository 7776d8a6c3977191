// load.spring: a spring at the motor's shaft, stiffness (theta - rest) against forward rotation. With
// gear.backlash, theta is the load's.

#include "model/effects/shaft_torque.h"

namespace hydro::model {

namespace {

struct ShaftSpring {
  template <class T>
  static T& Load(Terms<T>& x) {
    return x.shaft_load;
  }
  template <class T>
  static T Torque(const Terms<T>& x) {
    return x.own[0] * (x.shaft_angle - x.own[1]);
  }
};

[[maybe_unused]] const bool kLoadSpringAdded = AddToCatalogue(
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
              // With a clamped shaft, the oil is such a spring.
              .on_request = true},
     .make = MakeEffect<ShaftTorque<ShaftSpring>>});

}  // namespace

}  // namespace hydro::model
