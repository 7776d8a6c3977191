// pump.quadratic_drag: + k theta' |theta'| in eq. (4).

#include "model/effects/effect.h"

namespace hydro::model {

namespace {

class QuadraticDrag : public EffectOf<QuadraticDrag> {
 public:
  template <class T>
  void OwnTorquesAndFlows(Terms<T>& x) const {
    // The mode knows the direction of slip, so the term stays smooth although |theta'| is not.
    x.load += x.own[0] * static_cast<double>(x.mode->pump) * x.motor_speed * x.motor_speed;
  }
};

[[maybe_unused]] const bool kPumpQuadraticDragAdded =
    AddToCatalogue({.info = {.id = "pump.quadratic_drag",
                             .summary = "drag of the pump grows with the square of its speed",
                             .equation = "+ k theta' abs(theta')",
                             .confused_with = "parameter b",
                             .parameters = {{.name = "k",
                                             .unit = "in-lbf-s^2",
                                             .meaning = "drag per squared speed",
                                             .example = 0.001}}},
                    .make = MakeEffect<QuadraticDrag>});

}  // namespace

}  // namespace hydro::model
