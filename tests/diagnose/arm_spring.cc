// arm.spring: arm torque - stiffness alpha. A user's own effect: this file is all it takes.
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

[[maybe_unused]] const bool kSpringAdded = model::AddToCatalogue(
    {.info = {.id = "arm.spring",
              .summary = "a spring pulls the arm to its middle",
              .equation = "arm torque - stiffness alpha",
              .confused_with = "parameter m g l",
              .parameters = {{.name = "stiffness", .unit = "in-lbf/rad", .meaning = "torque per angle"}}},
     .make = model::MakeEffect<Spring>});

}  // namespace

}  // namespace hydro::diagnose
