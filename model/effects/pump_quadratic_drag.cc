// pump.quadratic_drag: + k theta' |theta'| in eq. (4).

#include "model/effects/effect.h"

namespace hydro::model {

namespace {

class QuadraticDrag : public EffectOf<QuadraticDrag> {
 public:
  template <class T>
  void OwnTorquesAndFlows(Terms<T>& x) const {
    // The mode knows the direction of slip, so the term stays smooth where |theta'| is not.
    x.load += x.own[0] * static_cast<double>(x.mode->pump) * x.motor_speed * x.motor_speed;
  }
};

}  // namespace

CatalogueEntry PumpQuadraticDrag();
CatalogueEntry PumpQuadraticDrag() {
  return {{"pump.quadratic_drag",
           "drag of the pump grows with the square of its speed",
           "+ k theta' abs(theta')",
           "parameter b",
           {{"k", "in-lbf-s^2", 0, kUnbounded, true, "drag per squared speed"}}},
          MakeEffect<QuadraticDrag>};
}

}  // namespace hydro::model
