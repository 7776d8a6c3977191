#include "tune/design/frequency_response.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <stdexcept>

#include "tune/design/second_order_fit.h"

namespace hydro::design {
namespace {

constexpr double kRate = 2000;  // Hz
constexpr double kPi = std::numbers::pi;

// Rest for 1 s, a sine from `first` to `last` Hz over `duration` s, rest for 1 s.
std::vector<double> SweptSine(double amplitude, double first, double last, double duration) {
  std::vector<double> signal(static_cast<size_t>((duration + 2) * kRate));
  for (size_t i = 0; i < signal.size(); ++i) {
    const double t = static_cast<double>(i) / kRate - 1;
    if (t > 0 && t < duration) {
      signal[i] = amplitude * std::sin(2 * kPi * (first * t + (last - first) / (2 * duration) * t * t));
    }
  }
  return signal;
}

// y_k = a1 y_{k-1} + a2 y_{k-2} + b x_{k-1}: a resonance at 24 Hz with damping .5, whose exact response is
// known.
struct Resonance {
  double a1, a2, b;
  Resonance() {
    const double wn = 150;
    const double zeta = 0.5;
    const double r = std::exp(-zeta * wn / kRate);
    a1 = 2 * r * std::cos(wn * std::sqrt(1 - zeta * zeta) / kRate);
    a2 = -r * r;
    b = 0.9 * (1 - a1 - a2);
  }
  std::vector<double> Respond(const std::vector<double>& x) const {
    std::vector<double> y(x.size());
    for (size_t k = 2; k < x.size(); ++k) y[k] = a1 * y[k - 1] + a2 * y[k - 2] + b * x[k - 1];
    return y;
  }
  std::complex<double> Gain(double frequency_hz) const {
    const std::complex<double> back = std::polar(1.0, -2 * kPi * frequency_hz / kRate);
    return b * back / (1.0 - a1 * back - a2 * back * back);
  }
};

// Tests that a swept sine through a known linear system gives its gain and phase, with coherence 1. Averaging
// leaves errors below 0.03 dB and 0.15 degrees.
TEST(FrequencyResponse, SweptSineGivesLinearSystemsGain) {
  const Resonance system;
  const std::vector<double> x = SweptSine(3, 1, 120, 10);
  const auto points = EstimateFrequencyResponse(x, system.Respond(x),
                                                {.sample_rate_hz = kRate, .first_hz = 2, .last_hz = 100});
  ASSERT_GE(points.size(), 30u);
  for (const ResponsePoint& point : points) {
    const std::complex<double> error = point.gain / system.Gain(point.frequency_hz);
    EXPECT_NEAR(Decibels(error), 0, 0.03) << point.frequency_hz;
    EXPECT_NEAR(std::arg(error) * 180 / kPi, 0, 0.15) << point.frequency_hz;
    EXPECT_GT(point.coherence, 0.999) << point.frequency_hz;
  }
}

// Tests that coherence is the linear share of the output's power: white noise through a gain of 2 with
// independent noise of equal power added has coherence 1/2 at every frequency.
TEST(FrequencyResponse, CoherenceIsTheLinearShare) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  std::vector<double> x(200000);
  std::vector<double> y(x.size());
  for (size_t i = 0; i < x.size(); ++i) {
    x[i] = normal(random);
    y[i] = 2 * x[i] + 2 * normal(random) + 50;
  }
  const auto points = EstimateFrequencyResponse(
      x, y,
      {.sample_rate_hz = kRate, .segment_s = 0.5, .first_hz = 20, .last_hz = 900, .points_per_decade = 10});
  ASSERT_EQ(points.size(), 17u);
  for (const ResponsePoint& point : points) {
    // Each point averages at least 400 independent lines: standard deviations of 2 to 4 %.
    EXPECT_NEAR(point.coherence, 0.5, 0.1) << point.frequency_hz;
    EXPECT_NEAR(std::abs(point.gain), 2, 0.3) << point.frequency_hz;
  }
}

// Tests that a pure delay shows as a phase that falls steadily, without jumps.
TEST(FrequencyResponse, PhaseOfDelayIsUnwrapped) {
  const std::vector<double> x = SweptSine(1, 1, 120, 10);
  std::vector<double> y(x.size());
  std::copy(x.begin(), x.end() - 20, y.begin() + 20);  // 10 ms
  const auto points =
      EstimateFrequencyResponse(x, y, {.sample_rate_hz = kRate, .first_hz = 5, .last_hz = 110});
  const std::vector<double> phases = PhasesDeg(points);
  for (size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(phases[i], -3.6 * points[i].frequency_hz, 1) << points[i].frequency_hz;
  }
}

// Tests that signals that cannot be analysed are refused, and that bands without input give no point.
TEST(FrequencyResponse, RefusesWhatCannotBe) {
  const std::vector<double> x = SweptSine(1, 1, 50, 4);
  EXPECT_THROW(EstimateFrequencyResponse(x, {1, 2}, {.sample_rate_hz = kRate}), std::invalid_argument);
  EXPECT_THROW(EstimateFrequencyResponse(x, x, {.sample_rate_hz = kRate, .segment_s = 7}),
               std::invalid_argument);
  const std::vector<double> nothing(x.size());
  EXPECT_TRUE(EstimateFrequencyResponse(nothing, x, {.sample_rate_hz = kRate}).empty());
}

// Tests that the bandwidth is where the gain crosses -3 dB of the passband, even between points.
TEST(FrequencyResponse, Bandwidth) {
  std::vector<ResponsePoint> points;
  for (double f = 1; f < 100; f *= 1.1) points.push_back({f, 2.0 / std::complex<double>(1, f / 10), 1});
  EXPECT_NEAR(BandwidthHz(points, 2), 10, 0.02);
  EXPECT_TRUE(std::isnan(BandwidthHz(points, 0.1)));
}

// Tests that a second-order response is fitted exactly, with and without a delay, and that its closed-form
// bandwidth is the paper's design: 190.8 rad/s for wn = 150, zeta = .5.
TEST(SecondOrderFit, RecoversItsOwn) {
  const SecondOrderModel truth = {0.985, 150, 0.5, 0.0004};
  EXPECT_NEAR(truth.BandwidthHz() * 2 * kPi, 190.8, 0.05);
  EXPECT_NEAR(std::abs(truth.Gain(truth.BandwidthHz())), 0.985 / std::numbers::sqrt2, 1e-12);
  std::vector<ResponsePoint> points;
  for (double f = 1; f < 100; f *= 1.2) points.push_back({f, truth.Gain(f), 1});
  points.push_back({100, 7, 0.5});  // does not count
  const SecondOrderFit fit = FitSecondOrder(points, {.with_delay = true});
  EXPECT_NEAR(fit.model.static_gain, 0.985, 1e-6);
  EXPECT_NEAR(fit.model.natural_frequency, 150, 1e-3);
  EXPECT_NEAR(fit.model.damping_ratio, 0.5, 1e-6);
  EXPECT_NEAR(fit.model.delay, 0.0004, 1e-8);
  EXPECT_LT(fit.rms_error_db, 1e-5);
  // Fitted without the delay, wn and zeta must absorb its 0.4 ms, and the remainder shows.
  EXPECT_GT(FitSecondOrder(points, {}).rms_error_deg, 0.1);
  EXPECT_THROW(FitSecondOrder({points.begin(), points.begin() + 3}, {}), std::invalid_argument);
}

// Tests that a lightly and a heavily damped response are found from the same start.
TEST(SecondOrderFit, FarFromTheStart) {
  for (const double zeta : {0.05, 2.0}) {
    const SecondOrderModel truth = {0.3, 60, zeta, 0};
    std::vector<ResponsePoint> points;
    for (double f = 1; f < 100; f *= 1.2) points.push_back({f, truth.Gain(f), 1});
    const SecondOrderFit fit = FitSecondOrder(points, {});
    EXPECT_NEAR(fit.model.natural_frequency, 60, 1e-3) << zeta;
    EXPECT_NEAR(fit.model.damping_ratio, zeta, 1e-5) << zeta;
  }
}

}  // namespace
}  // namespace hydro::design
