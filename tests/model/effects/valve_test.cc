#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/model/effects/effect_case.h"
#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

// Tests that a side below p3 - cracking fills with the time constant V/(beta conductance), and that the
// valves replace the ideal ones: close to them when they open at once and pass much, and never in addition.
TEST(Check, FillsFromBelowCracking) {
  for (const model::Integrator integrator : kIntegrators) {
    model::Actuator actuator(Sealed({"valve.check", {{"cracking", 30}, {"conductance", 1e-4}}, {}}),
                             HeldAt(20, integrator));
    actuator.Advance(0, 0.1);
    EXPECT_NEAR(actuator.Measure().p1, 70 - 50 * std::exp(-kStiffness * 1e-5), 1e-5) << Name(integrator);
  }
  Rig lazy(Table1Model({{"valve.check", {{"cracking", 30}, {"conductance", 1e-3}}, {}}}), HeldAt(100));
  Rig brisk(Table1Model({{"valve.check", {{"cracking", 0}, {"conductance", 1}}, {}}}), HeldAt(100));
  model::Actuator ideal(Table1Model(), HeldAt(100));
  double least = 100;
  for (int tick = 1; tick <= 1000; ++tick) {
    const double voltage = tick < 500 ? 3 : -2;
    for (Rig* rig : {&lazy, &brisk}) {
      rig->simulation->Advance(voltage, tick * 1e-4);
      ASSERT_EQ(rig->simulation->mode().valve_1, 0);
      ASSERT_EQ(rig->simulation->mode().valve_2, 0);
    }
    ideal.Advance(voltage, tick * 1e-4);
    ASSERT_NEAR(brisk.Measure().p1, ideal.Measure().p1, 0.2);
    ASSERT_NEAR(brisk.Measure().p2, ideal.Measure().p2, 0.2);
    least = std::min(least, lazy.Measure().p1);
    EXPECT_EQ(lazy.simulation->mode().effects[0], lazy.Measure().p1 < 70);
  }
  EXPECT_LT(least, 60);
}

// Tests that pressure above `set` flows off with the time constant V/(beta conductance), and that pressure
// below stays.
TEST(Relief, OpensAboveSet) {
  const model::EffectDescription relief = {"valve.relief", {{"set", 300}, {"conductance", 1e-4}}, {}};
  for (const model::Integrator integrator : kIntegrators) {
    Rig above(Sealed(relief), HeldAt(500, integrator));
    above.simulation->Advance(0, 0.1);
    EXPECT_NEAR(above.Measure().p1, 300 + 200 * std::exp(-kStiffness * 1e-5), 1e-5) << Name(integrator);
    EXPECT_EQ(above.Measure().p1, above.Measure().p2);
    model::Actuator below(Sealed(relief), HeldAt(299, integrator));
    below.Advance(0, 0.1);
    EXPECT_EQ(below.Measure().p2, 299) << Name(integrator);
  }
  // The side that is pumped up opens just where it passes `set`, and it alone.
  Rig pumped(Sealed(relief), HeldAt(250));
  double before = 0;
  for (int tick = 1; pumped.simulation->mode().effects[1] == 0; ++tick) {
    ASSERT_LT(tick, 10000);
    before = pumped.Measure().p2;
    pumped.simulation->Advance(3, tick * 1e-5);
  }
  EXPECT_LT(before, 300);
  EXPECT_GE(pumped.Measure().p2, 300);
  EXPECT_EQ(pumped.simulation->mode().effects[0], 0);
}

}  // namespace

}  // namespace hydro::testing
