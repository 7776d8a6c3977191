#include <gtest/gtest.h>

#include <cmath>

#include "tests/model/effects/effect_case.h"
#include "tests/model/effects/fluid_case.h"
#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

// Tests the same where the modulus grows with pressure, and that only the liquid's does beside air.
TEST(Stiffening, StiffAtHighPressure) {
  const auto beta = [](double p) { return 247000 + 200 * p; };
  const model::EffectDescription stiffening = {"fluid.stiffening", {{"slope", 200}}, {}};
  model::Actuator actuator(Sealed(stiffening, 1e-4), HeldAt(800));
  actuator.Advance(0, TimeToFall(800, 150, 1e-4, beta));
  EXPECT_NEAR(actuator.Measure().p1, 150, 1e-3);
  const model::Equations equations(Sealed(stiffening), Held(model::Shaft::kClamped));
  double rate[model::kMaxStates];
  const model::Terms<double> x = TermsAt(equations, {0, 0, 150, 800}, rate);  // each side has its own
  EXPECT_DOUBLE_EQ(x.beta_1, beta(150));
  EXPECT_DOUBLE_EQ(x.beta_2, beta(800));

  model::ModelDescription both = Sealed(stiffening, 1e-4);
  both.effects.push_back({"fluid.entrained_air", {{"air_fraction", 0.02}}, {}});
  const auto beta_both = [&](double p) {
    const double absolute = p + 14.6959;
    return 1 / (1 / beta(p) + 0.02 / (1.4 * absolute) * std::pow(14.6959 / absolute, 1 / 1.4));
  };
  model::Actuator with_air(both, HeldAt(800));
  with_air.Advance(0, TimeToFall(800, 150, 1e-4, beta_both));
  EXPECT_NEAR(with_air.Measure().p1, 150, 0.01);
}

}  // namespace
}  // namespace hydro::testing
