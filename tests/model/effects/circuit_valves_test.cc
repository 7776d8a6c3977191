// Pilot-operated check valves, a flushing shuttle and a gas accumulator: against closed forms; and the
// trouble that circuits for cylinders with a rod on one side are known for.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/model/effects/effect_case.h"
#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

model::EffectDescription Pilot(double ratio = 3) {
  return {
      "valve.pilot_check", {{"ratio", ratio}, {"cracking", 10}, {"range", 40}, {"conductance", 0.01}}, {}};
}

// Whether it is closed, between or wide open; and the flow out of side 1 there, at p1 and p2 with p_3 = 100.
void ExpectFlow(double p1, double p2, int position, double flow) {
  const model::Equations equations(Table1Model({Pilot()}), Held(model::Shaft::kClamped));
  std::vector<double> state = {0, 0, p1, p2};
  model::Mode mode;
  double rate[model::kMaxStates], margin[model::kMaxSwitches];
  for (int round = 0; round < 6; ++round) {
    equations.Rates(0, 0, mode, state.data(), rate, margin);
    for (int which = model::kFirstEffectSwitch; which < model::kFirstEffectSwitch + 2; ++which) {
      if (margin[which] < 0) equations.Cross(which, 0, 0, state.data(), &mode);
    }
  }
  model::Terms<double> x;
  equations.Evaluate(0, 0, mode, state.data(), rate, &x);
  EXPECT_EQ(mode.effects[0], position) << p1 << " " << p2;
  EXPECT_NEAR(x.valve_flow_1, flow, 1e-12) << p1 << " " << p2;
}

// Tests the check valve's own opening below p_3, and that the other side's pressure opens it against the
// side's own.
TEST(ValvePilotCheck, OpensByBothPressures) {
  ExpectFlow(95, 100, 0, 0);                          // below p_3 by less than the cracking pressure
  ExpectFlow(70, 100, 1, 0.01 * 0.5 * (70 - 100.0));  // (30 - 10)/40 open: oil comes in
  ExpectFlow(40, 100, 2, 0.01 * (40 - 100.0));
  ExpectFlow(120, 100, 0, 0);                            // shut above p_3 without a pilot
  ExpectFlow(120, 120, 1, 0.01 * 0.75 * (120 - 100.0));  // (-20 + 3 20 - 10)/40
  ExpectFlow(120, 200, 2, 0.01 * (120 - 100.0));         // wide open: oil goes out
  ExpectFlow(60, 40, 1, 0.01 * 0.75 * (60 - 100.0));     // the other side below p_3 does not pull it shut
  ExpectFlow(500, 200, 0, 0);                            // the load's side: 3 100 cannot open against 400
}

// Tests that the shuttle connects the side of the lower pressure, and neither near equal pressures.
TEST(ValveFlushing, ConnectsTheLowerSide) {
  const model::EffectDescription shuttle = {
      "valve.flushing", {{"shift", 50}, {"range", 40}, {"conductance", 0.01}}, {}};
  Rig rig(Sealed(shuttle), HeldAt(150));
  rig.simulation->Advance(0.2, 0.05);  // held by friction: 0.8 of 4 in-lbf
  EXPECT_EQ(rig.Measure().p1, 150);
  // The pump makes a difference; the lower side goes to p_3 with the time constant V/(beta conductance).
  rig.simulation->Advance(4, 0.2);
  EXPECT_NEAR(rig.Measure().p1, 100, 1);
  EXPECT_GT(rig.Measure().p2, 500);
  EXPECT_EQ(rig.simulation->mode().effects[0], 2);
  EXPECT_EQ(rig.simulation->mode().effects[1], 0);
}

// Tests the gas: p V^n stays while oil leaks in, moves out through valves and comes back, and no oil is lost.
TEST(AccumulatorGas, KeepsItsLaw) {
  const double precharge = 60, volume = 0.4, n = 1.3, air = 14.6959;
  for (const model::Integrator integrator : kIntegrators) {
    Rig rig(
        Table1Model({{"accumulator.gas", {{"precharge", precharge}, {"volume", volume}, {"exponent", n}}, {}},
                     {"valve.relief", {{"set", 300}, {"conductance", 1e-3}}, {}}}),
        HeldAt(105, integrator));
    const auto oil = [&] {  // in the sides, as compressed, and in the accumulator, as the gas has lost
      const double* state = rig.simulation->now().state;
      const double gas = volume * std::pow((precharge + air) / (state[4] + air), 1 / n);
      return (state[model::kP1] + state[model::kP2]) / kStiffness - gas;
    };
    const double start = oil();
    EXPECT_NEAR(rig.simulation->now().state[4], 100, 1e-12);
    double lowest = 1e9;
    for (int tick = 0; tick < 3000; ++tick) {
      rig.simulation->Advance(tick / 500 % 2 == 0 ? 3 : -2.5, (tick + 1) * 2e-4);
      ASSERT_NEAR(oil(), start, 2e-7) << Name(integrator) << " at tick " << tick;
      lowest = std::min(lowest, rig.simulation->now().state[4]);
    }
    EXPECT_LT(lowest, 99.8);
  }
}

// A cylinder of areas 1 to 0.65 with pilot-operated check valves, whose pump turns at a steady speed under a
// proportional speed loop, while a constant force loads it. Of the last second of four: the largest swing of
// side 2's pressure, and how often a valve opened or closed.
struct Swing {
  double pressure = 0;
  int openings = 0;
};

Swing SwingUnder(double force, double speed) {
  model::ModelDescription model = Table1Model(
      {{"actuator.unequal_areas", {{"difference", (1 - 0.65) / (1 + 0.65)}}, {}},
       {"actuator.seal_friction", {{"coulomb", 0}, {"viscous", 50}}, {}},
       {"valve.pilot_check", {{"ratio", 3}, {"cracking", 10}, {"range", 120}, {"conductance", 0.01}}, {}}});
  model.units.linear_arm = true;  // the weight is the same wherever it stands
  model.parameters.V_ms = 40;
  model.parameters.mgl = force;
  model::ActuatorOptions options = Held(model::Shaft::kFree);
  options.arm_angle = speed > 0 ? -3 : 3;  // in, to have way enough
  Rig rig(model, options);
  Swing swing;
  double low = 1e9, high = -1e9;
  model::Mode before;
  constexpr int kTicks = 4000;
  for (int tick = 0; tick < kTicks; ++tick) {
    const model::Measurement m = rig.Measure();
    const double wanted = speed * std::min(1.0, tick / 500.0);
    rig.simulation->Advance(std::clamp(0.5 * (wanted - m.motor_speed) + (speed > 0 ? 1 : -1), -10.0, 10.0),
                            (tick + 1) * 1e-3);
    const model::Mode& mode = rig.simulation->mode();
    if (tick >= kTicks * 3 / 4) {
      low = std::min(low, m.p2);
      high = std::max(high, m.p2);
      swing.openings += mode.effects != before.effects;
    }
    before = mode;
  }
  swing.pressure = high - low;
  return swing;
}

// Tests the oscillation between modes that such circuits are known for: a cylinder that is drawn in near the
// load at which both sides are at about the charge pressure does not settle, because neither valve can stay
// open: the pressures swing and the valves change for as long as the pump turns. With a clear load of either
// sign, and on the way out, all settle.
TEST(ValvePilotCheck, OscillatesBetweenItsModesNearZeroLoad) {
  for (const double force : {150.0, 300.0}) {
    const Swing swing = SwingUnder(force, -60);
    EXPECT_GT(swing.pressure, 50) << force;
    EXPECT_GT(swing.openings, 20) << force;
  }
  for (const double force : {-600.0, -150.0, 600.0, 900.0}) {
    const Swing swing = SwingUnder(force, -60);
    EXPECT_LT(swing.pressure, 1) << force;
    EXPECT_EQ(swing.openings, 0) << force;
  }
  for (const double force : {-600.0, 0.0, 600.0}) {
    EXPECT_LT(SwingUnder(force, 60).pressure, 1) << force;
  }
}

}  // namespace
}  // namespace hydro::testing
