// gear.load_friction: Coulomb friction that grows with the torque that a gear passes on, + (motor |T_p| + load |L|) sgn(theta'). T_p
// is the motor's torque and L what the shaft is loaded with besides friction: D dp and every other load. Where `load` is the larger,
// the load cannot turn the motor as easily as the motor the load.
//
// |y| is taken as sqrt(y^2 + w^2) - w with w = 1e-3 T_pmax, whose slope at y = 0 does not jump.

#include <cmath>

#include "model/effects/effect.h"

namespace hydro::model {

namespace {

// A gear that loses more than half of what it passes on holds any load by itself.
constexpr double kSelfLocking = 0.5;

class LoadFriction : public EffectOf<LoadFriction> {
 public:
  // When every torque on the shaft is known.
  template <class T>
  void OwnStates(Terms<T>& x, T* /*rate*/) const {
    const T w = 1e-3 * x.parameters->T_pmax;
    const T friction =
        x.own[0] * Magnitude(x.torque, w) + x.own[1] * Magnitude<T>(x.torque - x.net_torque, w);
    x.coulomb += friction;
    x.breakaway += friction;
  }

 private:
  template <class T>
  static T Magnitude(const T& y, const T& w) {
    using std::sqrt;
    return sqrt(y * y + w * w) - w;
  }
};

[[maybe_unused]] const bool kAdded =
    AddToCatalogue({.info = {.id = "gear.load_friction",
                             .summary = "friction grows with the torque that the gear passes on",
                             .equation = "+ (motor abs(T_p) + load abs(D dp + load)) sgn(theta')",
                             .confused_with = "pump.pressure_friction, parameters k_1 and T_s",
                             .parameters = {{.name = "motor",
                                             .unit = "1",
                                             .max = kSelfLocking,
                                             .meaning = "friction per torque on the motor's side",
                                             .example = 0.1},
                                            {.name = "load",
                                             .unit = "1",
                                             .max = kSelfLocking,
                                             .meaning = "friction per torque on the load's side",
                                             .example = 0.15}}},
                    .make = MakeEffect<LoadFriction>});

}  // namespace

}  // namespace hydro::model
