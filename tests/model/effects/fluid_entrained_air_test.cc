#include <gtest/gtest.h>

#include <cmath>

#include "tests/model/effects/effect_case.h"
#include "tests/model/effects/fluid_case.h"
#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

// Tests that pressure falls as the fluid's modulus says at each pressure: 1/beta plus that of air of which a
// volume 0.02 at 14.6959 psi has become 0.02 (p_atm/p)^(1/1.4).
TEST(EntrainedAir, SoftAtLowPressure) {
  const auto beta = [](double p) {
    const double absolute = p + 14.6959;
    return 1 / (1 / 247000.0 + 0.02 / (1.4 * absolute) * std::pow(14.6959 / absolute, 1 / 1.4));
  };
  model::Actuator actuator(Sealed({"fluid.entrained_air", {{"air_fraction", 0.02}}, {}}, 1e-4), HeldAt(800));
  actuator.Advance(0, TimeToFall(800, 150, 1e-4, beta));
  EXPECT_NEAR(actuator.Measure().p1, 150, 0.01);
  EXPECT_LT(beta(150), 0.4 * beta(800));

  const model::Equations equations(Sealed({"fluid.entrained_air", {{"air_fraction", 0.02}}, {}}),
                                   Held(model::Shaft::kClamped));
  double rate[model::kMaxStates];
  const model::Terms<double> x = TermsAt(equations, {0, 0, 150, 800}, rate);  // each side has its own
  EXPECT_NEAR(x.beta_1, beta(150), 1e-4 * beta(150));
  EXPECT_NEAR(x.beta_2, beta(800), 1e-4 * beta(800));
}

// Tests that air stays soft and finite down to a vacuum and below.
TEST(EntrainedAir, IsFiniteInAVacuum) {
  const model::Equations equations(Sealed({"fluid.entrained_air", {{"air_fraction", 0.02}}, {}}),
                                   Held(model::Shaft::kClamped));
  double last = 1e9;
  for (const double p : {100.0, 0.0, -14.0, -14.6959, -16.0, -100.0}) {
    const double state[4] = {0, 0, p, p};
    double rate[4];
    model::Terms<double> x;
    equations.Evaluate(0, 0, model::Mode{}, state, rate, &x);
    EXPECT_GT(x.beta_1, 0) << p;
    EXPECT_LT(x.beta_1, last) << p;
    last = x.beta_1;
  }
}

}  // namespace
}  // namespace hydro::testing
