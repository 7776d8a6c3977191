#include "model/trajectory/trajectory.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace hydro::trajectory {
namespace {

using ::testing::ElementsAre;

constexpr double kInf = std::numeric_limits<double>::infinity();

std::vector<double> Breaks(const Trajectory& trajectory, double from, double until) {
  std::vector<double> breaks;
  for (double t = trajectory.NextBreak(from); t <= until; t = trajectory.NextBreak(t)) breaks.push_back(t);
  return breaks;
}

// Compares Rate with central differences of Value at times that keep `h` away from every break.
void ExpectRatesMatchDifferences(const Trajectory& trajectory, double from, double until, double tolerance) {
  const double h = 1e-5;
  for (int i = 0; i <= 1000; ++i) {
    const double t = from + (until - from) * i / 1000;
    if (trajectory.NextBreak(t - 2 * h) <= t + 2 * h) continue;
    const double difference = (trajectory.Value(t + h) - trajectory.Value(t - h)) / (2 * h);
    EXPECT_NEAR(trajectory.Rate(t), difference, tolerance) << "t = " << t;
  }
}

void ExpectWithinRange(const Trajectory& trajectory, double from, double until) {
  double least = kInf, most = -kInf;
  for (int i = 0; i <= 20000; ++i) {
    const double value = trajectory.Value(from + (until - from) * i / 20000);
    EXPECT_GE(value, trajectory.Min());
    EXPECT_LE(value, trajectory.Max());
    least = std::min(least, value);
    most = std::max(most, value);
  }
  EXPECT_NEAR(least, trajectory.Min(), 1e-3);
  EXPECT_NEAR(most, trajectory.Max(), 1e-3);
}

// Tests that steps hold each value from exactly its time on.
TEST(StepsTest, HoldsValuesFromTheirTimes) {
  const auto steps = MakeSteps(0.5, {{0.1, 1.0}, {0.3, -2.0}});
  EXPECT_EQ(steps->Value(-5), 0.5);
  EXPECT_EQ(steps->Value(std::nextafter(0.1, 0)), 0.5);
  EXPECT_EQ(steps->Value(0.1), 1.0);
  EXPECT_EQ(steps->Value(500 / 5000.0), 1.0) << "the tick at 0.1 s is at the step";
  EXPECT_EQ(steps->Value(0.3), -2.0);
  EXPECT_EQ(steps->Value(1e9), -2.0);
  EXPECT_EQ(steps->Rate(0.1), 0.0);
  EXPECT_THAT(Breaks(*steps, -1, 10), ElementsAre(0.1, 0.3));
  EXPECT_EQ(steps->NextBreak(0.3), kInf);
  EXPECT_EQ(steps->Min(), -2.0);
  EXPECT_EQ(steps->Max(), 1.0);
  EXPECT_FALSE(steps->continuous());
}

// Tests that steps without any jump are a constant that a shaft can be held by.
TEST(StepsTest, ConstantIsContinuous) {
  EXPECT_TRUE(MakeSteps(0.2, {})->continuous());
  EXPECT_EQ(MakeSteps(0.2, {})->Value(3), 0.2);
  EXPECT_EQ(MakeSteps(0.2, {})->NextBreak(-kInf), kInf);
  EXPECT_TRUE(MakeSteps(0.2, {{1, 0.2}})->continuous());
}

// Tests the sine against its closed form, even far from its start.
TEST(SineTest, MatchesClosedForm) {
  const auto sine = MakeSine(1.0, 0.5, 2.0, 0.25, 0.0);
  EXPECT_EQ(sine->Value(0.2), 1.0);
  EXPECT_EQ(sine->Rate(0.2), 0.0);
  EXPECT_EQ(sine->Value(0.25), 1.0);
  EXPECT_DOUBLE_EQ(sine->Rate(0.25), 2 * M_PI * 2.0 * 0.5);
  EXPECT_NEAR(sine->Value(0.25 + 0.125), 1.5, 1e-15);
  EXPECT_NEAR(sine->Value(0.25 + 1e6 + 0.125), 1.5, 1e-9);
  for (double t : {0.3, 0.77, 1.9}) {
    EXPECT_NEAR(sine->Value(t), 1 + 0.5 * std::sin(2 * M_PI * 2 * (t - 0.25)), 1e-14);
  }
  ExpectRatesMatchDifferences(*sine, -1, 3, 1e-7);
  ExpectWithinRange(*sine, -1, 3);
  EXPECT_THAT(Breaks(*sine, -1, 10), ElementsAre(0.25));
  EXPECT_TRUE(sine->continuous());
}

// Tests that a phase makes the sine jump at its start, unless it is a multiple of pi.
TEST(SineTest, PhaseJumpsAtTheStart) {
  const auto cosine = MakeSine(0, 1, 1, 0, M_PI / 2);
  EXPECT_FALSE(cosine->continuous());
  EXPECT_NEAR(cosine->Value(0), 1, 1e-15);
  EXPECT_EQ(cosine->Rate(0), 0.0) << "0 at a jump";
  EXPECT_TRUE(MakeSine(0, 1, 1, 0, M_PI)->continuous());
  EXPECT_TRUE(MakeSine(0, 1, 1, 0, -6 * M_PI)->continuous());
  EXPECT_TRUE(MakeSine(0, 0, 1, 0, 1)->continuous());
}

// Tests that the square wave changes sides at each half period, on the sample a person would expect.
TEST(SquareTest, ChangesSidesOnTheExpectedSamples) {
  const auto square = MakeSquare(10, 300, 10, 0.1);
  const double rate = 5000;
  for (int tick = 0; tick < 20000; ++tick) {
    const int half = (tick - 500) / 250;  // 0.05 s are 250 ticks
    const double expected = tick < 500 ? 10 : half % 2 == 0 ? 310 : -290;
    ASSERT_EQ(square->Value(tick / rate), expected) << "tick " << tick;
  }
  EXPECT_EQ(square->Min(), -290);
  EXPECT_EQ(square->Max(), 310);
  EXPECT_FALSE(square->continuous());
  EXPECT_EQ(square->Rate(0.1), 0.0);
}

// Tests that the breaks of a square wave are exactly where its value changes.
TEST(SquareTest, BreaksAreWhereItJumps) {
  for (double frequency : {10.0, 3.0, 0.7, 123.456}) {
    for (double start : {0.0, 0.1, -3.7, 12345.678}) {
      const auto square = MakeSquare(0, 1, frequency, start);
      double t = start - 0.01;
      EXPECT_EQ(square->NextBreak(t), start);
      t = start;
      for (int k = 1; k < 200; ++k) {
        const double next = square->NextBreak(t);
        ASSERT_GT(next, t);
        ASSERT_NEAR(next, start + k / (2 * frequency), 1e-10);
        ASSERT_EQ(square->Value(next), -square->Value(t));
        ASSERT_EQ(square->Value(std::nextafter(next, -kInf)), square->Value(t));
        t = next;
      }
    }
  }
}

// Tests that a square wave's breaks advance even where its halves are shorter than the spacing of doubles.
TEST(SquareTest, BreaksAlwaysAdvance) {
  const auto square = MakeSquare(0, 1, 1e9, 0);
  double t = 1e8;
  for (int i = 0; i < 100; ++i) {
    const double next = square->NextBreak(t);
    ASSERT_GT(next, t);
    t = next;
  }
  EXPECT_EQ(square->NextBreak(kInf), kInf);
}

// Tests the chirp's phase against the integral of its frequency, and that nothing jumps where the sweep ends.
TEST(ChirpTest, PhaseIsTheIntegralOfTheFrequency) {
  const double f0 = 0.5, f1 = 8, start = 0.3, duration = 4;
  const auto chirp = MakeChirp(0.1, 0.2, f0, f1, start, duration);
  EXPECT_EQ(chirp->Value(0), 0.1);
  EXPECT_EQ(chirp->Value(start), 0.1);
  for (double s : {0.1, 1.0, 2.5, 4.0}) {
    const double cycles = f0 * s + (f1 - f0) * s * s / (2 * duration);
    EXPECT_NEAR(chirp->Value(start + s), 0.1 + 0.2 * std::sin(2 * M_PI * cycles), 1e-13);
  }
  const double end_cycles = (f0 + f1) / 2 * duration;
  EXPECT_NEAR(chirp->Value(start + 5.7), 0.1 + 0.2 * std::sin(2 * M_PI * (end_cycles + 1.7 * f1)), 1e-13);
  const double end = start + duration;
  EXPECT_NEAR(chirp->Value(end), chirp->Value(std::nextafter(end, 0)), 1e-13);
  EXPECT_NEAR(chirp->Rate(end), chirp->Rate(std::nextafter(end, 0)), 1e-11);
  ExpectRatesMatchDifferences(*chirp, -1, 8, 2e-6);
  ExpectWithinRange(*chirp, -1, 8);
  EXPECT_THAT(Breaks(*chirp, -1, 10), ElementsAre(start, end));
  EXPECT_TRUE(chirp->continuous());
}

// Tests that a chirp may sweep downwards and from 0 Hz.
TEST(ChirpTest, SweepsBothWays) {
  ExpectRatesMatchDifferences(*MakeChirp(0, 1, 10, 1, 0, 3), -1, 5, 5e-6);
  const auto from_rest = MakeChirp(0, 1, 0, 2, 0, 2);
  EXPECT_EQ(from_rest->Rate(0), 0.0);
  EXPECT_NEAR(from_rest->Value(1), std::sin(2 * M_PI * 0.5), 1e-15);
}

const std::vector<Step> kPoints = {{0.5, 1}, {1, 3}, {2, 3}, {2.5, 2}, {3, -1}, {5, -1.5}};

// Tests that held points are steps that begin with the first value.
TEST(PointsTest, HoldKeepsTheNewestPoint) {
  const auto hold = MakePoints(kPoints, Interpolation::kHold);
  EXPECT_EQ(hold->Value(0), 1.0);
  EXPECT_EQ(hold->Value(0.999), 1.0);
  EXPECT_EQ(hold->Value(1), 3.0);
  EXPECT_EQ(hold->Value(9), -1.5);
  EXPECT_EQ(hold->Rate(0.7), 0.0);
  EXPECT_FALSE(hold->continuous());
  EXPECT_THAT(Breaks(*hold, 0, 10), ElementsAre(0.5, 1, 2, 2.5, 3, 5));
}

// Tests straight lines between points and constants outside.
TEST(PointsTest, LinearJoinsPoints) {
  const auto linear = MakePoints(kPoints, Interpolation::kLinear);
  EXPECT_EQ(linear->Value(0), 1.0);
  EXPECT_DOUBLE_EQ(linear->Value(0.75), 2.0);
  EXPECT_DOUBLE_EQ(linear->Rate(0.75), 4.0);
  EXPECT_EQ(linear->Value(7), -1.5);
  EXPECT_EQ(linear->Rate(7), 0.0);
  EXPECT_TRUE(linear->continuous());
  ExpectRatesMatchDifferences(*linear, 0, 6, 1e-9);
  ExpectWithinRange(*linear, 0, 6);
}

// Tests that the cubic goes through its points, is monotone between them, and has a continuous rate
// everywhere.
TEST(PointsTest, CubicIsMonotoneAndSmooth) {
  const auto cubic = MakePoints(kPoints, Interpolation::kCubic);
  for (const Step& point : kPoints) {
    EXPECT_DOUBLE_EQ(cubic->Value(point.time), point.value);
    EXPECT_NEAR(cubic->Rate(point.time), cubic->Rate(std::nextafter(point.time, 0)), 1e-12);
    EXPECT_NEAR(cubic->Value(point.time), cubic->Value(std::nextafter(point.time, 0)), 1e-12);
  }
  for (size_t i = 1; i < kPoints.size(); ++i) {
    const double rise = kPoints[i].value - kPoints[i - 1].value;
    double last = kPoints[i - 1].value;
    for (int k = 1; k <= 200; ++k) {
      const double t = kPoints[i - 1].time + (kPoints[i].time - kPoints[i - 1].time) * k / 200;
      const double value = cubic->Value(t);
      EXPECT_GE((value - last) * (rise < 0 ? -1 : 1), -1e-15) << "t = " << t;
      if (rise == 0) {
        EXPECT_EQ(value, last);
      }
      last = value;
    }
  }
  EXPECT_EQ(cubic->Rate(0.5), 0.0) << "at rest where the constant outside begins";
  EXPECT_EQ(cubic->Rate(5), 0.0);
  ExpectRatesMatchDifferences(*cubic, 0, 6, 1e-6);
  ExpectWithinRange(*cubic, 0, 6);
  EXPECT_TRUE(cubic->continuous());
}

// Tests the interior slope of the cubic: the mean of the secants where the circle of Fritsch and Carlson
// allows it.
TEST(PointsTest, CubicSlopes) {
  const auto cubic = MakePoints({{0, 0}, {1, 1}, {2, 2.5}, {3, 3}}, Interpolation::kCubic);
  EXPECT_DOUBLE_EQ(cubic->Rate(1), 1.25);
  EXPECT_DOUBLE_EQ(cubic->Rate(2), 1.0);
  // Secants 1 and 10: the mean 5.5 leaves the circle of radius 3 about secant 1, so the slope there
  // becomes 3.
  EXPECT_DOUBLE_EQ(MakePoints({{0, 0}, {1, 1}, {2, 11}}, Interpolation::kCubic)->Rate(1), 3.0);
}

// Tests that one point is a constant.
TEST(PointsTest, OnePointIsAConstant) {
  for (auto kind : {Interpolation::kHold, Interpolation::kLinear, Interpolation::kCubic}) {
    const auto one = MakePoints({{1, 7}}, kind);
    EXPECT_EQ(one->Value(0), 7.0);
    EXPECT_EQ(one->Value(2), 7.0);
    EXPECT_EQ(one->Rate(1), 0.0);
    EXPECT_TRUE(one->continuous());
  }
}

}  // namespace
}  // namespace hydro::trajectory
