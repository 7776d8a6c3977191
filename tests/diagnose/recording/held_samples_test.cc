#include "diagnose/recording/held_samples.h"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <random>

#include "diagnose/recording/run_data.h"
#include "diagnose/recording_first.h"
#include "tests/diagnose/recording/swing.h"

namespace hydro::diagnose {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

constexpr size_t kRows = 6000;
constexpr double kNoise = 0.1;

double Motion(double t) { return 20 * std::sin(9 * t) + 5 * std::sin(31 * t); }

// The values that a sensor of so many rows a sample writes at 1 kHz, `late` rows late at most.
std::vector<double> Held(double rows_apart, const std::function<double(double)>& signal, double late = 0) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal(0, kNoise);
  std::uniform_real_distribution<double> uniform(0, late);
  std::vector<double> values(kRows, signal(0));
  double at = 0, next = 0;
  for (size_t i = 0; i < kRows; ++i) {
    if (static_cast<double>(i) >= next) {
      values[i] = signal(1e-3 * static_cast<double>(i)) + normal(random);
      at += rows_apart;
      next = at + uniform(random);
    } else {
      values[i] = values[i - 1];
    }
  }
  return values;
}

runs::MeasuredRun Recorded(std::vector<double> speed) {
  runs::MeasuredRun run;
  run.name = "slow";
  run.shaft = model::Shaft::kClamped;
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal;
  for (size_t i = 0; i < speed.size(); ++i) {
    run.time.push_back(1e-3 * static_cast<double>(i));
    run.voltage.values.push_back(i % 500 < 250 ? 2 : -2);
    run.p1.values.push_back(200 + 90 * std::cos(9 * run.time.back()) + 1.5 * normal(random));
  }
  run.motor_speed.values = std::move(speed);
  return run;
}

std::vector<std::string> LinesOf(runs::MeasuredRun* run) {
  std::vector<runs::MeasuredRun> runs = {*run};
  std::vector<std::string> lines = SetAsideRepeats(&runs);
  *run = std::move(runs[0]);
  return lines;
}

// Tests that of equal rows only the first is a sample, in whatever ratio the rates are, and that the noise is
// that of the samples.
TEST(HeldSamples, OnlyTheFirstCounts) {
  for (const double apart : {2.0, 2.5, 3.0, 10.0 / 3, 4.0, 7.2, 10.0}) {
    SCOPED_TRACE(apart);
    runs::MeasuredRun run = Recorded(Held(apart, Motion));
    const runs::MeasuredRun before = run;
    EXPECT_THAT(LinesOf(&run), ElementsAre(HasSubstr("run slow: motor_speed stays the same for ")));
    EXPECT_NEAR(static_cast<double>(CountValid(run.motor_speed.values)), kRows / apart, 2);
    EXPECT_NEAR(EstimateNoise(run.motor_speed.values), kNoise, 0.15 * kNoise);
    for (size_t i = 0; i < kRows; ++i) {
      if (std::isnan(run.motor_speed.values[i])) continue;
      EXPECT_EQ(run.motor_speed.values[i], before.motor_speed.values[i]);
    }
    EXPECT_EQ(run.voltage.values, before.voltage.values);
    EXPECT_EQ(run.p1.values, before.p1.values);
  }
}

// Tests samples that arrive up to a row late, and a converter whose samples equal the one before now and
// then.
TEST(HeldSamples, LateAndEqualSamples) {
  runs::MeasuredRun run = Recorded(Held(6, Motion, 0.9));
  EXPECT_EQ(LinesOf(&run).size(), 1u);
  std::vector<double> counts = Held(4, Motion);
  for (double& value : counts) value = 0.05 * std::round(value / 0.05);
  run = Recorded(counts);
  EXPECT_EQ(LinesOf(&run).size(), 1u);
}

// Tests that honest repeats stay: an encoder that turns slowly and steadily, a converter at rest, a value
// that rests, and a signal of its own in each row.
TEST(HeldSamples, HonestRepeatsStay) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal(0, 0.3);
  std::vector<double> encoder, at_rest, resting;
  for (size_t i = 0; i < kRows; ++i) {
    encoder.push_back(0.01 * std::floor(static_cast<double>(i) / 4 + 0.01));
    at_rest.push_back(std::round(normal(random)));
    resting.push_back(i % 600 < 300 ? 7 : 7 + 1e-3 * static_cast<double>(i % 600));
  }
  for (const std::vector<double>& values : {encoder, at_rest, resting, Held(1, Motion)}) {
    runs::MeasuredRun run = Recorded(values);
    EXPECT_THAT(LinesOf(&run), IsEmpty());
    EXPECT_EQ(run.motor_speed.values, values);
  }
}

// Tests that --check says it without calling the recording wrong, and finds no spikes or dropouts in it.
TEST(HeldSamples, IsSaidAndNoFault) {
  runs::MeasuredRun run = testing::Swing(model::Shaft::kClamped);
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal;
  for (auto* signal : {&run.p1, &run.p2, &run.motor_speed, &run.motor_angle}) {
    const double noise = signal == &run.motor_angle ? 1e-3 : signal == &run.motor_speed ? 0.1 : 2.0;
    for (double& value : signal->values) value += noise * normal(random);
  }
  for (size_t i = 0; i < run.samples(); ++i) run.motor_speed.values[i] = run.motor_speed.values[i - i % 3];
  const RecordingReport report = ReportOnRecordings(testing::Table1Model(), {run}, 1);
  EXPECT_THAT(report.wrong, IsEmpty());
  EXPECT_THAT(report.limits,
              ::testing::Contains(HasSubstr("motor_speed stays the same for 3 rows at a time")));
}

}  // namespace
}  // namespace hydro::diagnose
