// actuator.unequal_areas: a cylinder with its rod on one side. Of the actuator's displacement, side 1 has c
// (1 - difference) and side 2 c (1 + difference), in the flows, the volumes and the torque alike. The base
// parameters c and k_2 are the means of the two sides. The accumulator supplies the difference between what
// one side takes and the other gives, through leakage and the valves.

#include "model/effects/effect.h"

namespace hydro::model {

namespace {

class UnequalAreas : public EffectOf<UnequalAreas> {
 public:
  template <class T>
  void OwnProperties(Terms<T>& x) const {
    const T more = x.own[0] * x.parameters->c;
    x.c_1 -= more;
    x.c_2 += more;
    // V_1 = V - c_1 alpha, V_2 = V + c_2 alpha.
    x.V_1 += more * x.arm_angle;
    x.V_2 += more * x.arm_angle;
    x.pressure_torque += x.own[0] * x.parameters->k_2 * (x.p1 + x.p2);
  }

  // The sides displace unequal volumes at p_3, which the accumulator exchanges with them.
  void AddPower(const Terms<double>& x, const double* /*rate*/, Power* power) const override {
    const Parameters& p = *x.parameters;
    power->mismatch += x.own[0] * (p.c - p.k_2) * (x.p1 + x.p2) * x.actuator_speed;
    power->effects_stored -= 2 * x.own[0] * p.c * x.p_3 * x.actuator_speed;
  }
};

[[maybe_unused]] const bool kActuatorUnequalAreasAdded =
    AddToCatalogue({.info = {.id = "actuator.unequal_areas",
                             .summary = "the actuator's two sides have unequal areas",
                             .equation = "c_1 = c (1 - difference), c_2 = c (1 + difference); arm torque "
                                         "+ difference k_2 (p1 + p2)",
                             .confused_with = "sensor.pressure_gain, parameters c, k_2 and mgl",
                             .parameters = {{.name = "difference",
                                             .unit = "1",
                                             .min = -0.95,
                                             .max = 0.95,
                                             .meaning = "(c_2 - c_1)/(c_1 + c_2)",
                                             .sides = &Parameters::c,
                                             .example = 0.3}},
                             .needs_oil = true},
                    .make = MakeEffect<UnequalAreas>});

}  // namespace

}  // namespace hydro::model
