#include "diagnose/data/interval_means.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace hydro::diagnose {
namespace {

runs::MeasuredRun Ramp(size_t samples) {
  runs::MeasuredRun run;
  for (size_t i = 0; i < samples; ++i) run.time.push_back(0.01 * static_cast<double>(i));
  return run;
}

// Tests intervals of a long and of a short run: the means, of what is there, and the rates between the ends.
TEST(IntervalMeans, MeansAndRates) {
  const runs::MeasuredRun run = Ramp(3000);
  const IntervalMeans intervals(run);
  ASSERT_EQ(intervals.times().size(), 150u);
  EXPECT_DOUBLE_EQ(intervals.times()[0], 0.095);
  std::vector<double> values;
  for (const double time : run.time) values.push_back(3 * time + 1);
  values[1] = std::numeric_limits<double>::quiet_NaN();
  for (size_t i = 40; i < 60; ++i) values[i] = std::numeric_limits<double>::quiet_NaN();
  const std::vector<double> means = intervals.Means(values);
  EXPECT_NEAR(means[1], 3 * intervals.times()[1] + 1, 1e-12);
  EXPECT_TRUE(std::isnan(means[2]));
  const std::vector<double> rates = intervals.Rates(means);
  EXPECT_TRUE(std::isnan(rates.front()));
  EXPECT_TRUE(std::isnan(rates.back()));
  EXPECT_TRUE(std::isnan(rates[1]));
  EXPECT_NEAR(rates[7], 3, 1e-9);
  EXPECT_EQ(IntervalMeans(Ramp(10)).times().size(), 2u);  // of four samples each
}

}  // namespace
}  // namespace hydro::diagnose
