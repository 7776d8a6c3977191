// gear.backlash: play between the motor's shaft and a load with its own inertia. With twist = theta -
// theta_load, the two touch where |twist| > width/2; a spring and damper then transmit stiffness (twist -/+
// width/2) + damping twist'. load.gravity and load.spring act on the load. Two states, the load's angle and
// speed. Without damping the teeth bounce for as long as friction lets them; a load without a stated inertia
// is as heavy as the motor, J, which is usual where a gear was chosen to match the two. One switch: 0, apart;
// +1 and -1, the motor pushes forward or backward.

#include <cmath>

#include "model/effects/effect.h"

namespace hydro::model {

namespace {

class Backlash : public EffectOf<Backlash> {
 public:
  int states() const override { return 2; }
  int switches() const override { return 1; }
  std::vector<std::string> StateNames() const override { return {"load_angle", "load_speed"}; }
  void Scales(const StateSizes& of, double* scale) const override {
    scale[0] = of.angle;
    scale[1] = of.speed;
  }

  template <class T>
  void OwnStart(const Terms<T>& x, T* state) const {
    state[first_state()] = x.motor_angle;
    state[first_state() + 1] = x.motor_speed;
  }

  template <class T>
  void OwnProperties(Terms<T>& x) const {
    x.shaft_angle = x.state[first_state()];
  }

  // The torque through the gear replaces the load that the shaft carries.
  template <class T>
  void OwnStates(Terms<T>& x, T* rate) const {
    const T passed = Passed(x);
    x.load += passed - x.shaft_load;
    x.net_torque -= passed - x.shaft_load;
    rate[first_state()] = x.state[first_state() + 1];
    rate[first_state() + 1] = (passed - x.shaft_load) / x.own[3];
  }

  template <class T>
  void OwnMargins(const Terms<T>& x, T* margin) const {
    using std::abs;
    const double side = Side(x);
    const T twist = x.motor_angle - x.state[first_state()];
    margin[kFirstEffectSwitch + first_switch()] =
        side == 0 ? T(0.5 * x.own[0] - abs(twist)) : T(side * twist - 0.5 * x.own[0]);
  }

  template <class T>
  void OwnCross(int /*which*/, const Terms<T>& x, T* /*state*/, Mode* mode) const {
    const bool forward = x.motor_angle > x.state[first_state()];
    int8_t& position = mode->effects[first_switch()];
    position = static_cast<int8_t>(position != 0 ? 0 : (forward ? 1 : -1));
  }

  // The loads compute their work as if the motor's shaft carried them.
  void AddPower(const Terms<double>& x, const double* rate, Power* power) const override {
    const double speed = x.state[first_state() + 1], slip = x.motor_speed - speed;
    const double side = Side(x), passed = Passed(x), damped = side == 0 ? 0 : x.own[2] * slip;
    power->viscous += (x.shaft_load - passed) * x.motor_speed;
    power->effects_stored +=
        -x.shaft_load * slip + (passed - damped) * slip + x.own[3] * speed * rate[first_state() + 1];
    power->effects_dissipated += damped * slip;
  }

 private:
  template <class T>
  double Side(const Terms<T>& x) const {
    const int position = x.mode->effects[first_switch()];
    return position == 0 ? 0 : (position > 0 ? 1 : -1);
  }
  template <class T>
  T Passed(const Terms<T>& x) const {
    const double side = Side(x);
    if (side == 0) return T(0.0);
    const T twist = x.motor_angle - x.state[first_state()];
    return x.own[1] * (twist - 0.5 * side * x.own[0]) +
           x.own[2] * (x.motor_speed - x.state[first_state() + 1]);
  }
};

[[maybe_unused]] const bool kGearBacklashAdded = AddToCatalogue(
    {.info =
         {.id = "gear.backlash",
          .summary = "play between the motor's shaft and its load",
          .equation =
              "play of width, then stiffness and damping, between the motor and a load of its own inertia",
          .confused_with = "parameter J, arm.flexure",
          .parameters = {{.name = "width",
                          .unit = "rad",
                          .meaning = "the whole play, as an angle of the motor",
                          .starts = {0.01, 0.05},
                          .example = 0.02},
                         {.name = "stiffness",
                          .unit = "in-lbf/rad",
                          .min_allowed = false,
                          .meaning = "torque per twist where the teeth touch",
                          .starts = {20, 200},
                          .scale = Scale::kTorque,
                          .example = 200},
                         {.name = "damping",
                          .unit = "in-lbf-s",
                          .meaning = "torque per rate of twist where the teeth touch",
                          .starts = {0.1},
                          .scale = Scale::kTorque,
                          .example = 0.5,
                          .optional = true,
                          .standard = 0.0},
                         {.name = "inertia",
                          .unit = "lbf-in-s^2",
                          .min_allowed = false,
                          .meaning = "of the load, at the motor's speed",
                          .starts = {1},
                          .scale = Scale::kInertia,
                          .part_of = &Parameters::J,
                          .example = 0.005,
                          .optional = true,
                          .standard = {"J", [](const auto& p) { return p.J; }}}},
          // Starts: half a degree and three of play, in gears whose teeth the largest torque twists by as
          // much (1/200 and 1/20 rad). The load's own angle is not measured.
          .unseen_by_balances = true,
          .on_request = true},
     .make = MakeEffect<Backlash>});

}  // namespace

}  // namespace hydro::model
