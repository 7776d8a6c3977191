#include "model/equations/state_history.h"

#include <gtest/gtest.h>

#include "tests/model/model_case.h"

namespace hydro::testing {
namespace {

// Tests that the history is the cubic through its states and rates, with its slope as the derivative by time,
// and that a jump is seen from each side.
TEST(StateHistory, InterpolatesWithDerivatives) {
  const auto value = [](double t) { return 1 + t - 3 * t * t + 2 * t * t * t; };
  const auto slope = [](double t) { return 1 - 6 * t + 6 * t * t; };
  model::StateHistory<model::Jet> history(1, 10);
  for (const double t : {0.0, 0.3, 0.35, 0.35, 1.0}) {
    model::Jet y(value(t)), rate(slope(t));
    y.SetDerivative(3, 2 * t);  // another parameter's
    rate.SetDerivative(3, 2);
    history.Add(t, &y, &rate);
  }
  for (const double t : {0.0, 0.1, 0.299, 0.3, 0.35, 0.5, 0.99, 1.0}) {
    model::Jet time(t), state;
    time.SetDerivative(0, -1);  // a delay's
    history.At(&time, &state);
    EXPECT_NEAR(state.a, value(t), 1e-12) << t;
    EXPECT_NEAR(state.v[0], -slope(t), 1e-12) << t;
    EXPECT_NEAR(state.v[3], 2 * t, 1e-12) << t;
  }
  model::Jet before(-0.5), state;
  before.SetDerivative(0, -1);
  history.At(&before, &state);
  EXPECT_EQ(state.a, 1);
  EXPECT_EQ(state.v[0], 0);

  model::StateHistory<double> jump(1, 0.01);  // forgets what is not needed
  for (int i = 0; i <= 10000; ++i) {
    const double y = i < 5000 ? 1 : 2, zero = 0, one = 1;
    if (i == 5000) jump.Add(i * 1e-3, &one, &zero);
    jump.Add(i * 1e-3, &y, &zero);
    if (i == 5005) {
      double time = 4.9995, read = 0;
      jump.At(&time, &read);
      EXPECT_EQ(read, 1);
      time = 5.0005;
      jump.At(&time, &read);
      EXPECT_EQ(read, 2);
    }
  }
}

}  // namespace
}  // namespace hydro::testing
