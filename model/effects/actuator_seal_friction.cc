// actuator.seal_friction: arm torque - coulomb sgn(alpha') - viscous alpha'. The arm sticks while the net
// torque on it is within `coulomb`. One switch: 0 the arm sticks, +1 and -1 it moves in that direction. A
// clamped or driven shaft does not feel it.
#include <ceres/jet.h>

#include <cmath>

#include "model/effects/effect.h"

namespace hydro {

namespace {

class SealFriction : public EffectOf<SealFriction> {
 public:
  SealFriction(double coulomb, double viscous) : coulomb_(coulomb), viscous_(viscous) {}

  int switches() const override { return 1; }

  // After every torque on the arm is known.
  template <class T>
  void OwnStates(Terms<T>& x, T* /*rate*/) const {
    if (!x.arm_free) return;
    const int direction = x.mode->effects[first_switch()];
    if (direction == 0) {
      x.arm_torque = T(0.0);
    } else {
      x.arm_torque -= direction * coulomb_ + viscous_ * x.arm_speed;
    }
  }

  void Margins(const Terms<double>& x, double* margin) const override {
    const int direction = x.mode->effects[first_switch()];
    double& own = margin[kFirstEffectSwitch + first_switch()];
    if (!x.arm_free) {
      own = 1;
    } else if (direction == 0) {
      own = coulomb_ - std::abs(NetTorque(x));
    } else {
      own = direction * x.arm_speed;
    }
  }

  void Cross(int, const Terms<double>& x, double* state, Mode* mode) const override {
    int8_t& direction = mode->effects[first_switch()];
    if (direction != 0) state[kArmSpeed] = 0;
    const double torque = NetTorque(x);
    direction = std::abs(torque) <= coulomb_ ? 0 : (torque > 0 ? 1 : -1);
  }

  void AddPower(const Terms<double>& x, const double* /*rate*/, Power* power) const override {
    if (!x.arm_free) return;
    power->effects_dissipated += coulomb_ * std::abs(x.arm_speed) + viscous_ * x.arm_speed * x.arm_speed;
  }

 private:
  static double NetTorque(const Terms<double>& x) {
    return x.parameters->k_2 * (x.p2 - x.p1) - x.parameters->mgl * std::cos(x.arm_angle);
  }

  double coulomb_;
  double viscous_;
};

}  // namespace

CatalogueEntry ActuatorSealFriction();
CatalogueEntry ActuatorSealFriction() {
  return {{"actuator.seal_friction",
           "friction of the actuator's seals and the arm's bearing",
           "arm torque - coulomb sgn(alpha') - viscous alpha'",
           "parameter m g l on one-way motion",
           {{"coulomb", "in-lbf", 0, kUnbounded, true, "Coulomb friction on the arm"},
            {"viscous", "in-lbf-s", 0, kUnbounded, true, "viscous friction on the arm"}}},
          [](const EffectDescription& description, const Parameters&) -> std::unique_ptr<Effect> {
            return std::make_unique<SealFriction>(description.parameters.at("coulomb"),
                                                  description.parameters.at("viscous"));
          }};
}

}  // namespace hydro
