// pump.unequal_displacements: a pump whose ports displace unequal volumes, or two pumps on one shaft, to
// drive a cylinder with its rod on one side: D (1 - difference) at port 1, D (1 + difference) at port 2. A
// third port at p_3 takes the remainder.

#include "model/effects/effect.h"

namespace hydro::model {

namespace {

class UnequalDisplacements : public EffectOf<UnequalDisplacements> {
 public:
  // Torque D_2 p2 - D_1 p1 - (D_2 - D_1) p_3. The flow that leaves side 1 beyond D theta' and does not enter
  // side 2 passes the third port.
  template <class T>
  void OwnTorquesAndFlows(Terms<T>& x) const {
    x.load += x.own[0] * x.D * Pressures(x);
    const T flow = x.own[0] * x.D * x.motor_speed;
    x.outer_flow_1 -= flow;
    x.outer_flow_2 -= flow;
  }

  // The load's work goes to the oil; `viscous` and `leakage` contain it, with opposite signs.
  void AddPower(const Terms<double>& x, const double* /*rate*/, Power* power) const override {
    const double to_oil = x.own[0] * x.D * Pressures(x) * x.motor_speed;
    power->viscous -= to_oil;
    power->leakage += to_oil;
  }

 private:
  template <class T>
  static T Pressures(const Terms<T>& x) {
    return (x.pump_p1 - x.p_3) + (x.pump_p2 - x.p_3);
  }
};

[[maybe_unused]] const bool kPumpUnequalDisplacementsAdded = AddToCatalogue(
    {.info = {.id = "pump.unequal_displacements",
              .summary = "the pump's two ports displace unequal volumes",
              .equation = "D_1 = D (1 - difference), D_2 = D (1 + difference) in flow and torque; the "
                          "rest flows to the accumulator",
              .confused_with = "actuator.unequal_areas, sensor.pressure_gain",
              .parameters = {{.name = "difference",
                              .unit = "1",
                              .min = -0.95,
                              .max = 0.95,
                              .meaning = "(D_2 - D_1)/(D_1 + D_2)",
                              .sides = &Parameters::D,
                              .example = 0.2}},
              .needs_oil = true,
              // Pumps with three ports are rare, and the owner of one knows about it.
              .on_request = true},
     .make = MakeEffect<UnequalDisplacements>});

}  // namespace

}  // namespace hydro::model
