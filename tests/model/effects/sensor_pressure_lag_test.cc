#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/model/effects/effect_case.h"
#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

// Tests that the reading follows the pressure with a time constant, and that the gain acts on the reading.
TEST(PressureLag, FollowsItsClosedForm) {
  const double tau = 0.02, k = kStiffness * 1e-4;
  model::ModelDescription model = Sealed({"sensor.pressure_lag", {{"tau", tau}}, {}}, 1e-4);
  model.effects.push_back({"sensor.pressure_gain", {{"gain", 0.05}}, {}});
  model.effects.push_back({"sensor.pressure_offset", {{"p1", 3}, {"p2", 0}}, {}});
  for (const model::Integrator integrator : kIntegrators) {
    Rig rig(model, HeldAt(500, integrator));
    EXPECT_DOUBLE_EQ(rig.Measure().p2, 1.05 * 500);
    rig.simulation->Advance(0, 0.03);
    const double slow = 400 / (1 - k * tau);
    const double read = 100 + slow * std::exp(-k * 0.03) + (400 - slow) * std::exp(-0.03 / tau);
    EXPECT_NEAR(rig.simulation->now().state[model::kP1], 100 + 400 * std::exp(-k * 0.03), 1e-4);
    EXPECT_NEAR(rig.Measure().p2, 1.05 * read, 1e-4) << Name(integrator);
    EXPECT_NEAR(rig.Measure().p1, 1.05 * read + 3, 1e-4) << Name(integrator);
  }
}

// Tests that each transducer follows its own side.
TEST(PressureLag, EachSideHasItsOwn) {
  const model::Equations equations(Sealed({"sensor.pressure_lag", {{"tau", 0.02}}, {}}),
                                   Held(model::Shaft::kClamped));
  const std::vector<double> state = {0, 0, 200, 300, 150, 400};
  double rate[model::kMaxStates];
  TermsAt(equations, state, rate);
  EXPECT_DOUBLE_EQ(rate[4], (200 - 150) / 0.02);
  EXPECT_DOUBLE_EQ(rate[5], (300 - 400) / 0.02);
  const model::Measurement read = equations.Measure(0, state.data());
  EXPECT_EQ(read.p1, 150);
  EXPECT_EQ(read.p2, 400);
}

}  // namespace
}  // namespace hydro::testing
