#include <gtest/gtest.h>

#include <cmath>

#include "tests/model/effects/effect_case.h"
#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

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
