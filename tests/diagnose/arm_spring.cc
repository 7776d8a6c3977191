// arm.spring: arm torque - stiffness alpha. An effect that is not in the catalogue, added as a user
// would: this file is all there is to it.
#include "model/effects/effect.h"

namespace hydro::diagnose {

namespace {

class Spring : public model::EffectOf<Spring> {
 public:
  template <class T>
  void OwnTorquesAndFlows(model::Terms<T>& x) const {
    x.arm_torque -= x.own[0] * x.arm_angle;
  }

  void AddPower(const model::Terms<double>& x, const double* /*rate*/, model::Power* power) const override {
    if (x.arm_free) power->effects_stored += x.own[0] * x.arm_angle * x.arm_speed;
  }
};

[[maybe_unused]] const bool kAdded = model::AddToCatalogue(
    {{"arm.spring",
      "a spring pulls the arm to its middle",
      "arm torque - stiffness alpha",
      "parameter m g l",
      {{"stiffness", "in-lbf/rad", 0, model::kUnbounded, true, "of the spring", false, {}, {0}}}},
     model::MakeEffect<Spring>});

}  // namespace

}  // namespace hydro::diagnose
