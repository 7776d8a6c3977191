// arm.flexure: a spring and damper between actuator and arm. The actuator's shaft has no inertia of its own,
// so spring and damper pass on to the arm exactly the torque that the pressures give the shaft:
//   k_2 dp = stiffness (a - alpha) + damping (a' - alpha'),
// from which a' follows. One state: a, the angle of the actuator's shaft, on which V_1, V_2 and the flow c a'
// depend. The arm's sensor reads alpha, and friction (actuator.seal_friction) acts on the arm. A clamped or
// driven shaft is held at the actuator; the effect then does nothing.

#include "model/effects/effect.h"

namespace hydro::model {

namespace {

class Flexure : public EffectOf<Flexure> {
 public:
  int states() const override { return 1; }
  int actuator_angle_state() const override { return first_state(); }
  std::vector<std::string> StateNames() const override { return {"actuator_angle"}; }
  void Scales(const StateSizes& of, double* scale) const override { scale[0] = of.arm; }

  template <class T>
  void OwnStart(const Terms<T>& x, T* state) const {
    state[first_state()] = x.arm_angle;
    if (x.arm_free) state[first_state()] += x.pressure_torque / x.own[0];  // at rest
  }

  template <class T>
  void OwnProperties(Terms<T>& x) const {
    if (!x.arm_free) return;
    const T twist = x.state[first_state()] - x.arm_angle;
    x.actuator_speed = x.arm_speed + (x.pressure_torque - x.own[0] * twist) / x.own[1];
    x.V_1 -= x.c_1 * twist;
    x.V_2 += x.c_2 * twist;
  }

  template <class T>
  void OwnStates(Terms<T>& x, T* rate) const {
    rate[first_state()] = x.arm_free ? x.actuator_speed : T(0.0);
  }

  void AddPower(const Terms<double>& x, const double* /*rate*/, Power* power) const override {
    if (!x.arm_free) return;
    const double twist = x.state[first_state()] - x.arm_angle;
    const double speed = x.actuator_speed - x.arm_speed;
    power->effects_stored += x.own[0] * twist * speed;
    power->effects_dissipated += x.own[1] * speed * speed;
  }
};

[[maybe_unused]] const bool kArmFlexureAdded =
    AddToCatalogue({.info = {.id = "arm.flexure",
                             .summary = "the arm gives between actuator and load",
                             .equation = "a spring and damper between actuator and arm",
                             .confused_with = "line.wave, parameter J_a",
                             .parameters = {{.name = "stiffness",
                                             .unit = "in-lbf/rad",
                                             .min_allowed = false,
                                             .meaning = "torque per twist",
                                             .arm = -2,
                                             // A connection much stiffer than the oil does not show.
                                             .starts = {0.01, 0.06, 0.4},
                                             .scale = Scale::kArmStiffness,
                                             .example = 6000},
                                            {.name = "damping",
                                             .unit = "in-lbf-s",
                                             .min_allowed = false,
                                             .meaning = "torque per rate of twist",
                                             .arm = -2,
                                             .starts = {0.01},
                                             .scale = Scale::kArmDamping,
                                             .example = 60}},
                             // The angle of the actuator's own shaft is not measured.
                             .unseen_by_balances = true,
                             .needs_oil = true},
                    .make = MakeEffect<Flexure>});

}  // namespace

}  // namespace hydro::model
