// Figure 5: the closed pressure loop follows a sine.
#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <complex>
#include <nlohmann/json.hpp>
#include <numbers>

#include "base/units.h"
#include "experiments/figures/catalogue.h"
#include "experiments/studies/experiment.h"
#include "experiments/studies/tracking_study.h"

namespace hydro::experiments {
namespace {

using nlohmann::json;

// The first harmonic of dp over that of the reference, over whole periods.
std::complex<double> FirstHarmonic(const PressureLoopRun& run) {
  std::complex<double> in = 0, out = 0;
  for (size_t i = 0; i + 1 < run.time.size(); ++i) {
    if (run.time[i] < kWaveSettled - 0.5 / kLoopRate || std::isnan(run.reference[i])) continue;
    const auto wave = std::polar(1.0, -2 * std::numbers::pi * kWaveFrequency * run.time[i]);
    in += run.reference[i] * wave;
    out += run.dp[i] * wave;
  }
  return out / in;
}

}  // namespace

ExperimentResult RunFig5(const ExperimentOptions& options) {
  const TrackingStudy study = RunTrackingStudy(options, "fig5", "sine");
  const TrackingError& slow = study.by_frequency.front().error;
  const TrackingError& fast = study.by_frequency.back().error;
  const double fast_hz = study.by_frequency.back().frequency;
  const std::complex<double> harmonic = FirstHarmonic(study.wave);
  const double ratio = 2 * std::numbers::pi * kWaveFrequency / kLoopNaturalFrequency;
  const std::complex<double> linear =
      1.0 / std::complex<double>(1 - ratio * ratio, 2 * kLoopDampingRatio * ratio);

  ExperimentResult result = DescribeTracking(study);
  result.paper_says = "Figure 5 shows dp following a sine in experiment and simulation.";
  result.explanation = fmt::format(
                           "dp follows with {:.2f} times the amplitude, {:.1f} degrees late; a linear loop "
                           "of ω_n = {} rad/s and ζ = {} would give {:.2f} and {:.1f}. The motor is at its "
                           "limit {:.0f} % of the time, but {:.0f} % at {} Hz, where dp reaches only {:.0f} "
                           "psi. The RMS error of {:.0f} psi ({:.0f} at 1 Hz) comes from the lag, not from "
                           "the steady-state error, so the feed-forward hardly changes it ({:.0f}). ",
                           std::abs(harmonic), -Degrees(std::arg(harmonic)), kLoopNaturalFrequency,
                           kLoopDampingRatio, std::abs(linear), -Degrees(std::arg(linear)),
                           100 * study.error.saturated_fraction, 100 * fast.saturated_fraction, fast_hz,
                           fast.highest, study.error.rms, slow.rms, study.error_with.rms) +
                       SteadyStateText(study);
  result.comparisons.push_back({"amplitude of dp beside the reference's", "", "", std::abs(linear),
                                std::abs(harmonic), "expected: linear, both sides compressing, no friction"});
  result.comparisons.push_back(
      {"phase of dp", "degrees", "", Degrees(std::arg(linear)), Degrees(std::arg(harmonic)), "the same"});
  json numbers = ParseJson(result.numbers);
  numbers["first_harmonic"] = {{"gain", std::abs(harmonic)},
                               {"phase_deg", Degrees(std::arg(harmonic))},
                               {"linear_gain", std::abs(linear)},
                               {"linear_phase_deg", Degrees(std::arg(linear))}};
  result.numbers = JsonText(numbers);
  options.progress(1);
  return result;
}

}  // namespace hydro::experiments
