#include "tests/foreign_rig/recorder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/foreign_rig/recording.h"

namespace foreign_rig {
namespace {

// Samples of p1 while nothing moves.
std::vector<double> AtRest(const Recorder& recorder, double seconds) {
  Sensing sensing(recorder, 7, seconds);
  Reading reading;
  reading.p1 = 300;
  std::vector<double> samples;
  for (int k = 0; k < seconds * recorder.rate; ++k) {
    sensing.Follow(reading);
    samples.push_back(sensing.Take(k / recorder.rate)[kSide1]);
  }
  return samples;
}

double Correlation(const std::vector<double>& x, size_t lag) {
  double both = 0, own = 0;
  for (size_t i = 0; i + lag < x.size(); ++i) {
    both += (x[i] - 300) * (x[i + lag] - 300);
    own += (x[i] - 300) * (x[i] - 300);
  }
  return both / own;
}

// Tests that the noise has its standard deviation, and that its coloured part is correlated as long as
// stated.
TEST(Recorder, NoiseIsAsStated) {
  Recorder recorder;
  Channel& c = recorder.channels[kSide1];
  c.noise = 2;
  c.coloured = 0.5;
  c.colour_time = 0.01;
  const std::vector<double> samples = AtRest(recorder, 60);
  double square = 0;
  for (const double p : samples) square += (p - 300) * (p - 300) / static_cast<double>(samples.size());
  EXPECT_NEAR(std::sqrt(square), 2, 0.06);
  EXPECT_NEAR(Correlation(samples, 5), 0.5 * std::exp(-0.5), 0.04);
  EXPECT_NEAR(Correlation(samples, 200), 0, 0.04);
}

// Tests resolution and hum.
TEST(Recorder, StepsAndHum) {
  Recorder recorder;
  Channel& c = recorder.channels[kSide1];
  c.step = 0.5;
  c.hum = 3;
  double in_phase = 0, across = 0;
  const std::vector<double> samples = AtRest(recorder, 2);
  for (size_t k = 0; k < samples.size(); ++k) {
    EXPECT_EQ(std::remainder(samples[k], 0.5), 0);
    in_phase += (samples[k] - 300) * std::cos(2 * M_PI * 50 * static_cast<double>(k) / 1000) / 1000;
    across += (samples[k] - 300) * std::sin(2 * M_PI * 50 * static_cast<double>(k) / 1000) / 1000;
  }
  EXPECT_NEAR(std::hypot(in_phase, across), 3, 0.1);
  EXPECT_NEAR(NoiseUnit(c), std::sqrt(4.5 + 0.25 / 12), 1e-12);
}

// Tests that a filter follows a step with its time constant, and that a mean is over the last interval.
TEST(Recorder, FiltersAndMeans) {
  Recorder recorder;
  recorder.channels[kSide1].filter = 0.001;
  Sensing filtered(recorder, 1, 1);
  Reading reading;
  filtered.Follow(reading);
  reading.p1 = 100;
  for (int i = 0; i < 50; ++i) filtered.Follow(reading);
  EXPECT_NEAR(filtered.Take(0)[kSide1], 100 * (1 - std::exp(-1)), 1);

  Recorder averaging;
  averaging.averages = true;
  Sensing mean(averaging, 1, 1);
  for (int i = 1; i <= 50; ++i) {
    reading.p1 = i;
    mean.Follow(reading);
  }
  EXPECT_NEAR(mean.Take(0)[kSide1], 25.5, 1e-12);
}

// Tests how many spikes and lost samples there are, and that lost ones are missing or repeat.
TEST(Recorder, SpikesAndDropouts) {
  Recorder recorder;
  recorder.channels[kSide1].noise = 1;
  recorder.spikes = 5;
  int spikes = 0;
  for (const double p : AtRest(recorder, 60)) spikes += std::abs(p - 300) > 10 ? 1 : 0;
  EXPECT_NEAR(spikes, 300, 60);
  recorder.spikes = 0;
  recorder.dropouts = 2;
  int missing = 0;
  for (const double p : AtRest(recorder, 60)) missing += std::isnan(p) ? 1 : 0;
  EXPECT_NEAR(missing, 60 * 2 * 5.5, 200);
  recorder.dropout = Recorder::Dropout::kHeld;
  const std::vector<double> held = AtRest(recorder, 60);
  int repeats = 0;
  for (size_t i = 1; i < held.size(); ++i) repeats += held[i] == held[i - 1] ? 1 : 0;
  EXPECT_NEAR(repeats, 60 * 2 * 5.5, 200);
}

// Tests that a recording has its rate and length, that known jitter is in the time column and that times
// increase.
TEST(Recording, TimesAreAsTheRecorder) {
  Recorder recorder;
  recorder.rate = 500;
  const Plan plan = DrawPlans(3, 1, 0.3)[1];
  std::vector<Row> rows = Record(Rig{}, plan, recorder, 1, 5);
  ASSERT_EQ(rows.size(), 501u);
  EXPECT_DOUBLE_EQ(rows[500].time, 1);
  recorder.jitter = 0.1;
  recorder.jitter_known = true;
  rows = Record(Rig{}, plan, recorder, 1, 5);
  int off = 0;
  for (size_t i = 1; i < rows.size(); ++i) {
    EXPECT_GT(rows[i].time, rows[i - 1].time);
    off += std::abs(rows[i].time * 500 - static_cast<double>(i)) > 1e-9 ? 1 : 0;
  }
  EXPECT_GT(off, 400);
}

// Tests that a run begins in motion: what was commanded before the recording still acts.
TEST(Recording, StartsAnywhere) {
  int moving = 0;
  for (uint64_t seed = 1; seed <= 6; ++seed) {
    const Plan plan = DrawPlans(seed, 0.1, 0.3)[0];
    EXPECT_GT(plan.day.prelude, 0.2);
    moving += std::abs(Record(Rig{}, plan, Recorder{}, 0.1, 5)[0].sample[kSpeed]) > 1 ? 1 : 0;
  }
  EXPECT_GE(moving, 4);
}

}  // namespace
}  // namespace foreign_rig
