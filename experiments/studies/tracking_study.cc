#include "experiments/studies/tracking_study.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "experiments/studies/experiment.h"

namespace hydro::experiments {
namespace {

using nlohmann::json;

constexpr double kPictured = 0.3;  // s

double LargestDemand(const PressureLoopRun& run, const pressure_ctrl::PressureGains& gains) {
  const double k_1 = PressureLoopParameters().k_1;
  double largest = 0;
  for (size_t i = 0; i < run.time.size(); ++i) {
    if (run.time[i] < kWaveSettled) continue;
    const double error = run.reference[i] - run.dp[i];
    largest = std::max(largest, std::abs(k_1 * gains.k_p * (error - gains.k_v * run.motor_speed[i])));
  }
  return largest;
}

// `with` may be empty.
Picture WavePicture(const std::string& suffix, const std::string& caption, const PressureLoopRun& without,
                    const PressureLoopRun& with) {
  const page::Axis time{.label = "time, s", .min = 0, .max = kPictured};
  const double limit = PressureLoopParameters().T_pmax;
  page::Panel pressure{
      .title = "Pressure difference",
      .x = time,
      .y = {.label = "p_2 - p_1, psi"},
      .curves = {SignalCurve("reference", without, without.reference, 5, kPictured, page::Stroke::kDashed),
                 SignalCurve("without feed-forward", without, without.dp, 0, kPictured)},
      .height = 1.5};
  page::Panel torque{
      .title = "Motor torque",
      .x = time,
      .y = {.label = "T_p, in-lbf", .min = -1.25 * limit, .max = 1.25 * limit},
      .curves = {SignalCurve("without feed-forward", without, without.torque, 0, kPictured)},
      .rules = {{fmt::format("T_pmax = {} in-lbf", limit), false, limit}, {"", false, -limit}}};
  if (!with.time.empty()) {
    pressure.curves.push_back(SignalCurve("with feed-forward", with, with.dp, 1, kPictured));
    torque.curves.push_back(SignalCurve("with feed-forward", with, with.torque, 1, kPictured));
  }
  return {suffix, {.caption = caption, .panels = {pressure, torque}}};
}

json ErrorJson(const TrackingError& error) {
  return {{"rms_error_psi", error.rms},
          {"saturated_fraction", error.saturated_fraction},
          {"highest_dp_psi", error.highest},
          {"lowest_dp_psi", error.lowest}};
}

json Numbers(const TrackingStudy& study) {
  const FrictionBand band = StickingPressures(kWaveAmplitude, 0);
  json out = ErrorJson(study.error);
  out["amplitude_psi"] = kWaveAmplitude;
  out["frequency_hz"] = kWaveFrequency;
  out["k_p_V_per_psi"] = study.gains.k_p;
  out["k_v_psi_s_per_rad"] = study.gains.k_v;
  out["steady_state_error_psi"] = study.steady_state_error;
  out["sticking_band_psi"] = {band.low, band.high};
  out["largest_torque_demand_in_lbf"] = study.largest_demand;
  out["torque_limit_in_lbf"] = PressureLoopParameters().T_pmax;
  json with = ErrorJson(study.error_with);
  with["feedforward_V_per_psi"] = study.feedforward;
  with["steady_state_error_psi"] = study.steady_state_error_with;
  out["with_feedforward"] = with;
  out["by_frequency"] = json::array();
  for (const TrackingStudy::AtFrequency& at : study.by_frequency) {
    json row = ErrorJson(at.error);
    row["frequency_hz"] = at.frequency;
    out["by_frequency"].push_back(row);
  }
  if (!study.noisy.time.empty()) {
    out["with_noise"] = ErrorJson(MeasureTracking(study.noisy, kWaveSettled));
    out["with_noise"]["pressure_noise_psi"] = kPaperPressureNoise;
  }
  return out;
}

}  // namespace

std::string WaveReference(const std::string& kind, double frequency) {
  return fmt::format("signal = \"pressure\"\nkind = \"{}\"\namplitude = {}\nfrequency_hz = {}\n", kind,
                     kWaveAmplitude, frequency);
}

TrackingStudy RunTrackingStudy(const ExperimentOptions& options, const std::string& figure,
                               const std::string& kind) {
  const model::Parameters p = PressureLoopParameters();
  TrackingStudy study;
  study.figure = figure;
  study.kind = kind;
  study.gains = PressureLoopGains();
  study.feedforward = pressure_ctrl::SteadyStateFeedforward(p, study.gains);
  study.tuned_feedforward = study.feedforward + p.T_s / (p.k_1 * kWaveAmplitude);

  const auto run = [&](const std::string& name, const std::string& reference, double duration,
                       double feedforward, double noise = 0) {
    return RunPressureLoop(options.run_stack, {.name = figure + "-" + name,
                                               .reference = reference,
                                               .duration = duration,
                                               .feedforward = feedforward,
                                               .motion = "",
                                               .pressure_noise = noise,
                                               .seed = options.seed});
  };
  const std::string wave = WaveReference(kind, kWaveFrequency);
  const std::string constant =
      fmt::format("signal = \"pressure\"\nkind = \"steps\"\nsteps = [[0, {}]]\n", kWaveAmplitude);
  study.wave = run("wave", wave, kWaveDuration, 0);
  study.wave_with = run("wave-feedforward", wave, kWaveDuration, study.feedforward);
  study.hold = run("hold", constant, kHoldDuration, 0);
  study.hold_with = run("hold-feedforward", constant, kHoldDuration, study.feedforward);
  if (options.noise) study.noisy = run("wave-noise", wave, kWaveDuration, 0, kPaperPressureNoise);
  options.progress(0.4);

  study.error = MeasureTracking(study.wave, kWaveSettled);
  study.error_with = MeasureTracking(study.wave_with, kWaveSettled);
  study.steady_state_error = MeanError(study.hold, kHoldDuration);
  study.steady_state_error_with = MeanError(study.hold_with, kHoldDuration);
  study.largest_demand = LargestDemand(study.wave, study.gains);
  for (const double frequency : {1.0, 2.0, 5.0, 10.0, 20.0}) {
    if (frequency == kWaveFrequency) {
      study.by_frequency.push_back({frequency, study.error});
      continue;
    }
    const double duration = std::max(kWaveDuration, 2 / frequency);
    const PressureLoopRun other =
        run(fmt::format("{}Hz", frequency), WaveReference(kind, frequency), duration, 0);
    study.by_frequency.push_back({frequency, MeasureTracking(other, duration / 2)});
  }
  options.progress(0.8);
  return study;
}

ExperimentResult DescribeTracking(const TrackingStudy& study) {
  const model::Parameters p = PressureLoopParameters();
  const std::string wave = study.kind == "square" ? "square wave" : study.kind;
  ExperimentResult result;
  result.conditions = fmt::format(
      "Table 1, clamped at α = 0, eq. (16) over the stack at {} Hz without delay, k_p = {:.4f} V/psi and k_v "
      "= {:.2f} psi s/rad (ω_n = {} rad/s, ζ = {}, both sides compressing), |T_p| <= {} in-lbf. Reference: "
      "{} Hz {}, ±{} psi (the paper prints neither). Errors are over the last {} s; the steady state is that "
      "of a reference held at {} psi. Feed-forward: {:.5f} V/psi.",
      kLoopRate, study.gains.k_p, study.gains.k_v, kLoopNaturalFrequency, kLoopDampingRatio, p.T_pmax,
      kWaveFrequency, wave, kWaveAmplitude, kWaveDuration - kWaveSettled, kWaveAmplitude, study.feedforward);
  result.comparisons = {
      {"steady-state error without feed-forward", "psi", "not zero",
       kWaveAmplitude - SettledPressure(kWaveAmplitude, 0), study.steady_state_error,
       "expected: balance of eqs. (4) and (16) while the pump creeps"},
      {"steady-state error with feed-forward", "psi", "could be eliminated",
       kWaveAmplitude - SettledPressure(kWaveAmplitude, study.feedforward), study.steady_state_error_with,
       "T_s remains, which a term linear in the reference cancels at one reference only"},
      {"RMS error without feed-forward", "psi", "", page::kAutomatic, study.error.rms, ""},
      {"RMS error with feed-forward", "psi", "", page::kAutomatic, study.error_with.rms, ""},
      {"time at the torque limit, without feed-forward", "%", "", page::kAutomatic,
       100 * study.error.saturated_fraction, ""},
      {"time at the torque limit, with feed-forward", "%", "", page::kAutomatic,
       100 * study.error_with.saturated_fraction, ""}};
  result.numbers = JsonText(Numbers(study));
  result.table.columns = {{"time_s", study.wave.time},
                          {"pressure_ref_psi", study.wave.reference},
                          {"dp_psi", study.wave.dp},
                          {"p1_psi", study.wave.p1},
                          {"p2_psi", study.wave.p2},
                          {"motor_speed_rad_s", study.wave.motor_speed},
                          {"torque_in_lbf", study.wave.torque},
                          {"dp_with_feedforward_psi", study.wave_with.dp},
                          {"torque_with_feedforward_in_lbf", study.wave_with.torque}};
  const std::string caption =
      fmt::format("Closed pressure loop, Table 1, clamped at α = 0, {} Hz {} of ±{} psi, from rest.",
                  kWaveFrequency, wave, kWaveAmplitude);
  result.pictures.push_back(WavePicture("", caption, study.wave, study.wave_with));
  if (!study.noisy.time.empty()) {
    result.pictures.push_back(WavePicture(
        "-noise",
        caption + fmt::format(" Each pressure is measured with Gaussian noise of {} psi, and the loop acts "
                              "on what is measured (assumed: the paper shows noise but prints no level).",
                              kPaperPressureNoise),
        study.noisy, {}));
  }
  return result;
}

std::string SteadyStateText(const TrackingStudy& study) {
  const FrictionBand band = StickingPressures(kWaveAmplitude, 0);
  return fmt::format(
      "Held at {} psi, dp settles {:.1f} psi short. Leakage always pulls it down, so in the end the pump "
      "creeps forward, and an error must pay for D dp, for the creep through the k_v term, and for T_s. The "
      "feed-forward of {:.5f} V/psi pays for the first two and leaves {:.1f} psi at every reference, because "
      "friction does not grow with it; {:.5f} V/psi pays for friction too, but at {} psi only. A pump at "
      "rest with dp between {:.1f} and {:.1f} psi (without feed-forward) stays at rest, and leakage carries "
      "dp to the lower end.",
      kWaveAmplitude, study.steady_state_error, study.feedforward, study.steady_state_error_with,
      study.tuned_feedforward, kWaveAmplitude, band.low, band.high);
}

}  // namespace hydro::experiments
