// Where effects show most.
#include "diagnose/verdict/effect_stretch.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/diagnose/verdict/small_search.h"

namespace hydro::testing {
namespace {

// Tests that the stretch is a 25th of the fitted run or 60 samples, with the model near the measurement with the
// effect and away from it without, in the signal that shows the effect.
TEST(StretchOf, ShowsWhereTheEffectMatters) {
  SmallSearch& small = OfADrag();
  const auto stretch = diagnose::StretchOf(small.context, small.search.best, "pump.quadratic_drag");
  ASSERT_TRUE(stretch.has_value());
  EXPECT_EQ(stretch->run, "clamped 0");
  ASSERT_EQ(stretch->time.size(), 60u);
  ASSERT_EQ(stretch->with.size(), 60u);
  double with = 0, without = 0;
  for (size_t i = 0; i < 60; ++i) {
    if (std::isnan(stretch->measured[i])) continue;
    with += std::pow(stretch->with[i] - stretch->measured[i], 2);
    without += std::pow(stretch->without[i] - stretch->measured[i], 2);
  }
  EXPECT_GT(without, 4 * with);
}

// Tests that an effect that the model does not have shows nowhere.
TEST(StretchOf, NothingWithoutTheEffect) {
  SmallSearch& small = OfADrag();
  EXPECT_FALSE(diagnose::StretchOf(small.context, small.search.best, "amp.lag").has_value());
}

}  // namespace
}  // namespace hydro::testing
