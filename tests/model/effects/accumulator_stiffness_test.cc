#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/model/effects/effect_case.h"
#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

// Tests that what leaks from both sides raises p3: e = p - p3 falls with (beta/V + 2 stiffness) c_E.
TEST(AccumulatorStiffness, RisesWithWhatReturns) {
  const double k = 3e4, c_E = 1e-5, rate = (kStiffness + 2 * k) * c_E, time = 0.7;
  for (const model::Integrator integrator : kIntegrators) {
    Rig rig(Sealed({"accumulator.stiffness", {{"stiffness", k}}, {}}, c_E), HeldAt(500, integrator));
    rig.simulation->Advance(0, time);
    const double passed = c_E * 400 * (1 - std::exp(-rate * time)) / rate;  // in^3 of each side
    EXPECT_NEAR(rig.simulation->now().state[4], 100 + 2 * k * passed, 1e-4) << Name(integrator);
    EXPECT_NEAR(rig.Measure().p1, 500 - kStiffness * passed, 1e-4) << Name(integrator);
  }
}

// Tests that valves that open and close lose no fluid, so that V/beta (p1 + p2) + p3/stiffness stays; that a
// side whose valve is open is at p3, and that none is below it.
TEST(AccumulatorStiffness, LosesNoFluid) {
  const double k = 5e3;
  for (const bool bypass : {false, true}) {
    for (const model::Integrator integrator : kIntegrators) {
      model::ActuatorOptions options = HeldAt(bypass ? 100 : 105, integrator);
      options.bypass = bypass;
      Rig rig(Table1Model({{"accumulator.stiffness", {{"stiffness", k}}, {}},
                           {"valve.relief", {{"set", 300}, {"conductance", 1e-3}}, {}}}),
              options);
      const double start = rig.Measure().p1 * 2 / kStiffness + 100 / k;
      double lowest = 1e9;
      bool opened = false;
      for (int tick = 0; tick < 3000; ++tick) {
        rig.simulation->Advance(tick / 500 % 2 == 0 ? 3 : -2.5, (tick + 1) * 2e-4);
        const double* state = rig.simulation->now().state;
        const model::Mode& mode = rig.simulation->mode();
        ASSERT_NEAR((state[model::kP1] + state[model::kP2]) / kStiffness + state[4] / k, start, 1e-9 * start)
            << Name(integrator) << " at tick " << tick;
        ASSERT_GE(state[model::kP1], state[4]);
        ASSERT_GE(state[model::kP2], state[4]);
        if (mode.valve_1) {
          ASSERT_EQ(state[model::kP1], state[4]);
        }
        if (mode.valve_2) {
          ASSERT_EQ(state[model::kP2], state[4]);
        }
        opened |= mode.valve_1 != 0;
        lowest = std::min(lowest, state[4]);
      }
      EXPECT_EQ(opened, !bypass);
      EXPECT_EQ(lowest < 95, !bypass);
    }
  }
}

// Tests the same at one instant where the bypass is open and so is the valve, which stands for both: both
// sides are held, and the accumulator gives what leaks back to it.
TEST(AccumulatorStiffness, HoldsBothSidesOfTheBypass) {
  const model::Equations equations(Table1Model({{"accumulator.stiffness", {{"stiffness", 5e3}}, {}}}),
                                   Bypassed());
  const double state[5] = {0, 0, 120, 120, 100};
  model::Mode mode;
  mode.valve_1 = 1;
  double rate[model::kMaxStates];
  model::Terms<double> x;
  equations.Evaluate(0, 0, mode, state, rate, &x);
  ASSERT_GT(x.outer_flow_1 + x.outer_flow_2, 1e-5);
  EXPECT_EQ(rate[model::kP1], rate[4]);
  EXPECT_EQ(rate[model::kP2], rate[4]);
  EXPECT_NEAR((rate[model::kP1] + rate[model::kP2]) / kStiffness + rate[4] / 5e3, 0, 1e-12);
}

}  // namespace
}  // namespace hydro::testing
