#include <gtest/gtest.h>

#include <cmath>

#include "tests/model/effects/effect_case.h"
#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

// Tests that the pressure difference of a pump at rest falls as an orifice allows: its square root falls
// linearly, at k beta/V.
TEST(TurbulentLeakage, RootFallsEvenly) {
  for (const double sign : {1.0, -1.0}) {
    Rig rig(Sealed({"pump.turbulent_leakage", {{"k", 2e-5}}, {}}), HeldAt(600));
    rig.simulation->Advance(sign * 1.5, 0.3);
    rig.simulation->Advance(0, 0.6);
    ASSERT_EQ(rig.simulation->mode(), model::Mode{});
    const double before = rig.Measure().p2 - rig.Measure().p1;
    ASSERT_GT(sign * before, 100);
    rig.simulation->Advance(0, 1.6);
    const double root = std::sqrt(sign * before) - kStiffness * 2e-5;
    EXPECT_NEAR(rig.Measure().p2 - rig.Measure().p1, sign * root * root, 0.01);
  }
}

// Tests that the orifice is at the pump, where a line lies between it and the actuator.
TEST(TurbulentLeakage, SeesThePumpsPressures) {
  model::ModelDescription model = Sealed({"pump.turbulent_leakage", {{"k", 2e-5}}, {}});
  model.effects.push_back(Wave(300, 0.2, 0.05));
  const model::Equations equations(model, Held(model::Shaft::kClamped));
  double rate[model::kMaxStates];
  const model::Terms<double> x = TermsAt(equations, {0, 0, 100, 300, 100, 0, 500, 0}, rate);
  EXPECT_NEAR(x.cross_flow, 2e-5 * std::sqrt(400), 1e-8);
}

// Tests that the flow is laminar below about 2e-4 T_pmax/D, 1 psi for Table 1, and the orifice's above.
TEST(TurbulentLeakage, LaminarAtSmallDifferences) {
  const model::Equations equations(Sealed({"pump.turbulent_leakage", {{"k", 2e-5}}, {}}),
                                   Held(model::Shaft::kClamped));
  const model::Parameters p = Table1();
  const double width = 2e-4 * p.T_pmax / p.D;
  EXPECT_NEAR(width, 1, 0.01);
  double rate[model::kMaxStates];
  for (const double dp : {-10.0, -1e-3, 0.0, 1e-3, 1.0, 10.0}) {
    const model::Terms<double> x = TermsAt(equations, {0, 0, 100, 100 + dp, 0, 0}, rate);
    EXPECT_NEAR(x.cross_flow, 2e-5 * dp / std::pow(dp * dp + width * width, 0.25), 1e-15) << dp;
  }
}

}  // namespace
}  // namespace hydro::testing
