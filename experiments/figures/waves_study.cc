#include "experiments/figures/waves_study.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/units.h"
#include "experiments/runs/pressure_sweep.h"
#include "experiments/runs/shipped_models.h"
#include "experiments/studies/bode_case.h"
#include "settings/model_file.h"

namespace hydro::experiments {
namespace {

constexpr double kInitialPressure = 1500;  // psi; leaks away slowly, so both sides stay above p_3
constexpr double kTrialStep = 0.2;  // psi; small, so that a growing wave does not reach the torque limit

// Table 1 with waves, but without Coulomb friction: moving the pump at 300 Hz against 4 in-lbf takes
// amplitudes beyond the motor.
model::ModelDescription WithWaves(double frequency_hz, double volume_fraction, double damping) {
  model::ModelDescription model = ShippedModel("table1");
  model.parameters.T_s = 0;
  model.effects.push_back(
      {"line.wave",
       {{"frequency", frequency_hz}, {"volume_fraction", volume_fraction}, {"damping", damping}},
       {}});
  return model;
}

WaveLimits FindLimits(const design::LinearPressureLoop& loop, const model::Parameters& p,
                      const pressure_ctrl::PressureGains& gains) {
  const auto stable = [&](double natural_frequency) {
    return loop.Growth(pressure_ctrl::DerivePressureGains(p, 0, natural_frequency, kLoopDampingRatio, 2)) < 0;
  };
  double low = kLoopNaturalFrequency / 3;
  double high = low;
  while (high < kMostFrequency && stable(high)) {
    low = high;
    high *= 1.02;
  }
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (stable(middle) ? low : high) = middle;
  }
  return {design::LargestStableFactor(loop, gains, kMostFactor), low};
}

GainTrial RunTrial(const model::ModelDescription& model, const design::LoopTiming& timing,
                   const pressure_ctrl::PressureGains& gains, double factor, const StackRunner& run_stack) {
  constexpr double kDuration = 1.5;
  const double rate = 1 / timing.interval;
  const tables::Table table = run_stack(
      {fmt::format("waves-{}-of-limit", factor),
       ClampedLoopConfig({.initial_pressure = kInitialPressure,
                          .duration = kDuration,
                          .rate_hz = std::round(rate),
                          .delay_ticks = timing.delay_ticks,
                          .gains = gains,
                          .reference = fmt::format("kind = \"steps\"\nsteps = [[0.1, {}]]\n", kTrialStep)}),
       settings::FormatModel(model)});
  GainTrial trial = {factor, table.Find("time_s")->values, table.Find("p2_psi")->values, 0, 0};
  const std::vector<double>& p1 = table.Find("p1_psi")->values;
  for (size_t i = 0; i < p1.size(); ++i) trial.dp[i] -= p1[i];
  trial.expected = design::LinearPressureLoop(LinearisedClamped(model), timing).LeastDampedPole(gains).real();
  // Swings over about half a period, in two windows.
  const auto half_period = static_cast<size_t>(std::lround(rate / kWaveHz / 2));
  const auto swing = [&](double from, double to) {
    double largest = 0;
    for (auto i = static_cast<size_t>(from * rate); i < static_cast<size_t>(to * rate); ++i) {
      largest = std::max(largest, std::abs(trial.dp[i] - trial.dp[i - half_period]));
    }
    return largest;
  };
  trial.growth = std::log(swing(1.2, 1.4) / swing(0.4, 0.6)) / 0.8;
  return trial;
}

// The linearised loop's result: the wave's mode and the gains that it allows.
void AnalyseAnalogLoop(WavesStudy* study) {
  const design::LinearPressureLoop analog(study->linear, {});
  const std::complex<double> open_pole = WavePole(analog, {});
  study->closed_pole = WavePole(analog, study->gains);
  study->mode_hz = std::abs(open_pole) / (2 * std::numbers::pi);
  study->mode_damping = -open_pole.real() / std::abs(open_pole);
  study->limits = FindLimits(analog, study->p, study->gains);
  study->at_pump =
      FindLimits(design::LinearPressureLoop(SensedAtPump(study->linear), {}), study->p, study->gains);
}

void AnalyseSampledLoops(WavesStudy* study) {
  study->sampled = {{{1e-4, 0}, {}}, {{1e-4, 1}, {}}, {{2e-4, 0}, {}}, {{2e-4, 1}, {}}, {{1e-3, 1}, {}}};
  for (SampledPressureLoop& one : study->sampled) {
    one.limits = FindLimits(design::LinearPressureLoop(study->linear, one.timing), study->p, study->gains);
  }
}

void RunSweep(const StackRunner& run_stack, WavesStudy* study) {
  PressureSweep& sweep = study->sweep;
  sweep = {.name = "waves", .model = study->model, .gains = study->gains, .amplitude = 30};
  sweep.initial_pressure = kInitialPressure;
  sweep.rate_hz = 10000;
  sweep.bands = {{6, 100, 5, 1.5, 16}, {100, 250, 5, 2, 64}, {250, 350, 6, 4, 400}, {350, 600, 5, 2, 64}};
  study->swept = RunPressureSweep(sweep, run_stack);
  const design::LinearPressureLoop linear = study->swept_linear();
  for (const design::ResponsePoint& point : study->swept.points) {
    const std::complex<double> error = point.gain / linear.ClosedGain(study->gains, point.frequency_hz);
    study->worst_db = std::max(study->worst_db, std::abs(design::Decibels(error)));
    study->worst_deg = std::max(study->worst_deg, Degrees(std::abs(std::arg(error))));
    if (point.frequency_hz > 200 && std::abs(point.gain) > std::abs(study->peak.gain)) study->peak = point;
  }
}

void RunTrials(const StackRunner& run_stack, WavesStudy* study) {
  const SampledPressureLoop& shipped = study->shipped();
  const pressure_ctrl::PressureGains& gains = study->gains;
  for (const double beside : {0.95, 1.05}) {
    study->trials.push_back(RunTrial(study->model, shipped.timing,
                                     {beside * shipped.limits.gain.factor * gains.k_p, gains.k_v}, beside,
                                     run_stack));
  }
}

void VaryLine(WavesStudy* study) {
  for (const double fraction : {0.03, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5}) {
    const double hz = ClosedFormHz(fraction);
    // Keeps the line's resistance too, so the mode's damping varies as 1/w.
    const double damping = kWaveDamping * kWaveHz / hz;
    const design::LinearPressureLoop loop(LinearisedClamped(WithWaves(hz, fraction, damping)), {});
    study->by_volume.push_back({fraction, damping, hz, std::abs(WavePole(loop, {})) / (2 * std::numbers::pi),
                                FindLimits(loop, study->p, study->gains)});
  }
  for (const double damping : {0.005, 0.01, 0.02, 0.05}) {
    const design::LinearPressureLoop loop(LinearisedClamped(WithWaves(kWaveHz, kVolumeFraction, damping)),
                                          {});
    study->by_damping.push_back({kVolumeFraction, damping, kWaveHz,
                                 std::abs(WavePole(loop, {})) / (2 * std::numbers::pi),
                                 FindLimits(loop, study->p, study->gains)});
  }
}

}  // namespace

model::LinearModel LinearisedClamped(const model::ModelDescription& model) {
  const model::Equations equations(model, {.shaft = model::Shaft::kClamped});
  double state[model::kMaxStates];
  model::Mode mode;
  equations.Start(1000, state, &mode);
  return model::Linearise(equations, 0, 0, BothCompress(), state);
}

model::LinearModel SensedAtPump(model::LinearModel model) {
  for (int i = 0; i < model.states; ++i) {
    for (int output = 0; output < model.outputs; ++output) {
      double& c = model.C[output + i * model.outputs];
      if (model.output_names[output] == "p1") c = model.state_names[i] == "pump_p1";
      if (model.output_names[output] == "p2") c = model.state_names[i] == "pump_p2";
    }
  }
  return model;
}

std::complex<double> WavePole(const design::LinearPressureLoop& loop,
                              const pressure_ctrl::PressureGains& gains) {
  std::complex<double> wave = 0;
  for (const std::complex<double> pole : loop.VisiblePoles(gains)) {
    if (pole.imag() > wave.imag()) wave = pole;
  }
  return wave;
}

double ClosedFormHz(double volume_fraction) {
  return kWaveHz *
         std::sqrt(kVolumeFraction * (1 - kVolumeFraction) / (volume_fraction * (1 - volume_fraction)));
}

WavesStudy StudyWaves(const ExperimentOptions& options) {
  WavesStudy study;
  study.p = ShippedModel("table1").parameters;
  study.gains = pressure_ctrl::DerivePressureGains(study.p, 0, kLoopNaturalFrequency, kLoopDampingRatio, 2);
  study.model = WithWaves(kWaveHz, kVolumeFraction, kWaveDamping);
  study.linear = LinearisedClamped(study.model);
  AnalyseAnalogLoop(&study);
  AnalyseSampledLoops(&study);
  options.progress(0.2);
  RunSweep(options.run_stack, &study);
  options.progress(0.6);
  RunTrials(options.run_stack, &study);
  options.progress(0.8);
  VaryLine(&study);
  return study;
}

}  // namespace hydro::experiments
