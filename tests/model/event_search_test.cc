// The search for events within a step.
#include "model/integrate/event_search.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace hydro::testing {
namespace {

constexpr double kWidth = 1e-11;

// Tests that the time found is just past the first zero, for margins of every shape that modes have: steep,
// flat at the end, curved, scaled up and down.
TEST(TimeJustPast, BracketsTheZero) {
  for (const double zero : {1e-9, 1e-4, 0.3, 0.999999}) {
    for (const double scale : {1e-6, 1.0, 1e9}) {
      const auto margins = {+[](double t, double z) { return z - t; },
                            +[](double t, double z) { return z * z - t * t; },
                            +[](double t, double z) { return std::exp(-20 * t) - std::exp(-20 * z); },
                            +[](double t, double z) { return std::cbrt(z - t); }};
      for (const auto margin : margins) {
        int evaluations = 0;
        const auto g = [&](double t) {
          ++evaluations;
          return scale * margin(t, zero);
        };
        const double t = model::TimeJustPast(0, g(0), 1, g(1), kWidth, g);
        EXPECT_LT(g(t), 0);
        EXPECT_NEAR(t, zero, kWidth);
        EXPECT_LT(evaluations, 200);
      }
    }
  }
}

// Tests that a margin that is 0 at the start and falls at once gives an event at the start, and one that
// first rises gives the later zero.
TEST(TimeJustPast, StartsOnTheBoundary) {
  EXPECT_LE(model::TimeJustPast(0, 0, 1, -1, kWidth, [](double t) { return -t; }), kWidth);
  const auto arch = [](double t) { return t * (0.4 - t); };
  EXPECT_NEAR(model::TimeJustPast(0, 0, 1, arch(1), kWidth, arch), 0.4, kWidth);
}

// Tests that the search ends where the clock's resolution is coarser than the width.
TEST(TimeJustPast, EndsAtTheClocksResolution) {
  const double start = 1e6;
  const auto g = [&](double t) { return start + 0.5 - t; };
  const double t = model::TimeJustPast(start, 0.5, start + 1, -0.5, kWidth, g);
  EXPECT_NEAR(t, start + 0.5, 1e-9);
}

// Tests that a cubic that dips below 0 between two good ends is seen at its minimum, and that others are not.
TEST(DipWithin, FindsTheLeast) {
  constexpr double kNever = std::numeric_limits<double>::infinity();
  const auto ends = [](double h, double t_least, double g_least) {  // g = g_least + (t - t_least)^2
    return model::MarginEnds{g_least + t_least * t_least, -2 * t_least,
                             g_least + (h - t_least) * (h - t_least), 2 * (h - t_least)};
  };
  EXPECT_NEAR(DipWithin(1, ends(1, 0.3, -0.01)), 0.3, 1e-12);
  EXPECT_NEAR(DipWithin(2e-4, ends(2e-4, 1e-4, -1e-12)), 1e-4, 1e-12);
  EXPECT_EQ(DipWithin(1, ends(1, 0.3, 0.01)), kNever);
  EXPECT_EQ(model::DipWithin(1, {1, -1, 0.5, -1}), kNever);
  EXPECT_EQ(model::DipWithin(1, {1, 1, 0.5, 1}), kNever);
}

}  // namespace
}  // namespace hydro::testing
