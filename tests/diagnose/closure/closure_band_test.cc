#include "diagnose/closure/closure_band.h"

#include <gtest/gtest.h>

#include <vector>

#include "tests/diagnose/small_runs.h"

namespace hydro::diagnose {
namespace {

constexpr double kKnots[] = {-100, 0, 100};

// A curve of three values over speed, with as many equally good samples at each, and the model's own b free beside it
// if asked for: then what a straight line does is the same as another b.
Closure Banded(bool with_b) {
  model::EffectDescription curve;
  curve.id = "closure.pump_torque";
  curve.name_lists["against"] = {"motor_speed"};
  curve.lists["knots"] = {std::begin(kKnots), std::end(kKnots)};
  curve.lists["values"] = {0.1, 0.0, -0.1};
  Fitted fitted;
  fitted.hypothesis = testing::WithFree(testing::Table1With({curve}),
                                        with_b ? std::vector<std::string>{"b"} : std::vector<std::string>{});
  fitted.hypothesis.effects = {curve.id};
  const std::vector<FreeParameter> free = fitted.hypothesis.Free();
  const size_t n = free.size();
  constexpr double kSamples = 1e4;
  fitted.runs.resize(1);
  fitted.runs[0].information.assign(n * n, 0);
  fitted.runs[0].gradient.assign(n, 0);
  for (size_t knot = 0; knot < 3; ++knot) {
    std::vector<double> slopes(n, 0);  // of the residual there
    size_t value = 0;
    for (size_t i = 0; i < n; ++i) {
      if (free[i].name == "b") {
        slopes[i] = -kKnots[knot] * free[i].Slope();
      } else if (value++ == knot) {
        slopes[i] = 1;
      }
    }
    for (size_t i = 0; i < n; ++i) {
      for (size_t k = 0; k < n; ++k)
        fitted.runs[0].information[i * n + k] += kSamples * slopes[i] * slopes[k];
    }
  }
  Closure closure;
  closure.id = curve.id;
  SetBand(fitted, {}, &closure);
  return closure;
}

double Width(const Closure& closure, size_t knot) { return closure.high.at(knot) - closure.low.at(knot); }

// Tests that a curve which nothing else can stand for is known as well as its samples say.
TEST(ClosureBand, AsTheSamplesSay) {
  const Closure closure = Banded(false);
  for (size_t knot = 0; knot < 3; ++knot) EXPECT_NEAR(Width(closure, knot), 2 * 1.96 / 100, 1e-5);
  EXPECT_NEAR((closure.low[0] + closure.high[0]) / 2, 0.1, 1e-12);
}

// Tests that the line which another viscous friction would do widens the band by what b may be off, and no more.
TEST(ClosureBand, WithAnotherFriction) {
  const Closure closure = Banded(true);
  const double by_b = 2 * 1.96 * kNear * testing::Table1().b * 100;
  EXPECT_NEAR(Width(closure, 0), std::hypot(by_b, 2 * 1.96 / 100), 0.02 * by_b);
  EXPECT_NEAR(Width(closure, 1), 2 * 1.96 / 100, 1e-3);
}

}  // namespace
}  // namespace hydro::diagnose
