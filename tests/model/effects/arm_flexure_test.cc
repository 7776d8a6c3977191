#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/model/effects/effect_case.h"
#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

// Tests an arm on a spring and damper behind a locked actuator against a separate integration: the trapped
// fluid gives dp = beta log((1 - c a/V)/(1 + c a/V)) in closed form.
TEST(Flexure, ArmSwingsOnItsSpring) {
  const double K = 6000, B = 60, c = 1.83 * 1.83 * 2.20 / 2, mgl = 562;
  model::ModelDescription model = Sealed({"arm.flexure", {{"stiffness", K}, {"damping", B}}, {}});
  model.parameters.mgl = mgl;
  const auto rates = [&](const double* y, double* rate) {  // alpha, alpha', a
    const double dp = 247000 * std::log((1 - c * y[2] / 3.16) / (1 + c * y[2] / 3.16));
    rate[0] = y[1];
    rate[1] = (3.68 * dp - mgl * std::cos(y[0])) / 23.3;
    rate[2] = y[1] + (3.68 * dp - K * (y[2] - y[0])) / B;
  };
  double y[3] = {0, 0, 0};
  const double h = 5e-6;
  model::ActuatorOptions options = Held(model::Shaft::kFree, model::Integrator::kAuto);
  options.initial_pressure = 1000;
  Rig rig(model, options);
  double lowest = 0;
  for (int i = 1; i <= 80000; ++i) {
    double k1[3], k2[3], k3[3], k4[3], at[3];
    rates(y, k1);
    for (int j = 0; j < 3; ++j) at[j] = y[j] + h / 2 * k1[j];
    rates(at, k2);
    for (int j = 0; j < 3; ++j) at[j] = y[j] + h / 2 * k2[j];
    rates(at, k3);
    for (int j = 0; j < 3; ++j) at[j] = y[j] + h * k3[j];
    rates(at, k4);
    for (int j = 0; j < 3; ++j) y[j] += h / 6 * (k1[j] + 2 * k2[j] + 2 * k3[j] + k4[j]);
    lowest = std::min(lowest, y[0]);
    if (i % 2000 != 0) continue;
    rig.simulation->Advance(0, i * h);
    const double* state = rig.simulation->now().state;
    EXPECT_NEAR(rig.Measure().arm_angle, y[0], 1e-6);
    EXPECT_NEAR(state[6], y[2], 1e-7);
    EXPECT_NEAR(state[model::kP2] - state[model::kP1],
                247000 * std::log((1 - c * y[2] / 3.16) / (1 + c * y[2] / 3.16)), 1e-2);
  }
  EXPECT_LT(lowest, -0.12);  // it swings well beyond its rest at -mgl/K
}

// Tests that the spring starts at rest under whatever pressures a run starts with.
TEST(Flexure, StartsAtRest) {
  const model::Equations equations(Sealed({"arm.flexure", {{"stiffness", 6000}, {"damping", 60}}, {}}),
                                   Held(model::Shaft::kFree));
  std::vector<double> state = {0, 0, 150, 180, 0.1, 0, 0};
  double rate[model::kMaxStates];
  model::Terms<double> x = TermsAt(equations, state, rate);
  const model::Effect& flexure = *equations.data().effects[0];
  x.own = equations.data().own.data() + flexure.first_parameter();
  flexure.Start(x, state.data());
  EXPECT_DOUBLE_EQ(state[6], 0.1 + 3.68 * (180 - 150) / 6000);
  TermsAt(equations, state, rate);
  EXPECT_NEAR(rate[6], 0, 1e-12);
}

}  // namespace
}  // namespace hydro::testing
