// load.gravity: a weight on an arm that the motor's shaft carries, with the torque m g l sin(theta + phase)
// against forward rotation; m g l is the parameter `mgl`. With gear.backlash, theta is the load's. A
// weight at the hydraulic arm is the base parameter mgl.

#include <cmath>
#include <numbers>

#include "model/effects/shaft_torque.h"

namespace hydro::model {

namespace {

struct ShaftWeight {
  template <class T>
  static T& Load(Terms<T>& x) {
    return x.shaft_load;
  }
  template <class T>
  static T Torque(const Terms<T>& x) {
    using std::sin;
    return x.own[0] * sin(x.shaft_angle + x.own[1]);
  }
};

[[maybe_unused]] const bool kLoadGravityAdded = AddToCatalogue(
    {.info = {.id = "load.gravity",
              .summary = "a weight hangs on the motor's shaft",
              .equation = "T -= mgl sin(theta + phase)",
              .confused_with = "motor.cogging with one period, load.spring over a small angle",
              .parameters = {{.name = "mgl",
                              .unit = "in-lbf",
                              .min = -kUnbounded,
                              .meaning = "largest torque of the weight; negative: half a turn on",
                              .example = 3},
                             {.name = "phase",
                              .unit = "rad",
                              .min = -kUnbounded,
                              .meaning = "angle of the weight from hanging down at theta = 0",
                              .starts = {0, std::numbers::pi / 2},
                              .role = Role::kPhase,
                              .example = 0.4}},
              // With oil, the weight is the arm's (mgl), and a torque once a turn comes from an eccentric
              // shaft.
              .of_bare_motors = true},
     .make = MakeEffect<ShaftTorque<ShaftWeight>>});

}  // namespace

}  // namespace hydro::model
