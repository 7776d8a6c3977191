// The pressure waves in the lines, measured at about 300 Hz: where they appear, and which gain they allow.
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "experiments/figures/catalogue.h"
#include "experiments/figures/waves_study.h"
#include "experiments/runs/shipped_models.h"
#include "experiments/studies/bode_case.h"
#include "experiments/studies/experiment.h"

namespace hydro::experiments {
namespace {

using nlohmann::json;

constexpr double kOil = 7.95e-5;     // lbf s^2/in^4, 0.85 kg/l: ASSUMED, used only for the length of line
constexpr double kShownDecay = 100;  // 1/s

json Describe(const WaveLimits& limits, const pressure_ctrl::PressureGains& gains) {
  const bool limited = limits.gain.factor < kMostFactor;
  return {{"highest_stable_k_p_V_per_psi", limited ? json(limits.gain.factor * gains.k_p) : json(nullptr)},
          {"factor", limited ? json(limits.gain.factor) : json(nullptr)},
          {"oscillates_at_hz", limited ? json(limits.gain.frequency_hz) : json(nullptr)},
          {"highest_stable_natural_frequency_rad_s",
           limits.natural_frequency < kMostFrequency ? json(limits.natural_frequency) : json(nullptr)}};
}

page::Panel TrialPanel(const GainTrial& trial) {
  return {.title = fmt::format("k_p at {:.0f} % of its limit: {:+.1f} 1/s measured, {:+.1f} 1/s expected",
                               100 * trial.factor, trial.growth, trial.expected),
          .x = {.label = "time, s", .min = 0},
          .y = {.label = "dp, psi"},
          .curves = {page::Line("", trial.time, trial.dp, 0)}};
}

std::string Conditions(const WavesStudy& study) {
  return fmt::format(
      "Table 1 with line.wave: frequency {} Hz, {:.0f} % of V_ms on the pump's side of the line, damping {} "
      "(the last two ASSUMED), clamped at α = 0, both sides compressing. Coulomb friction is left out: at "
      "300 Hz it would hold the pump. Gains k_p = {:.4f} V/psi, k_v = {:.2f} psi s/rad (ω_n = {} rad/s, ζ = "
      "{}). Swept sine of ±{} psi, 6 to 600 Hz, over the stack at {} Hz without command delay.",
      kWaveHz, 100 * kVolumeFraction, kWaveDamping, study.gains.k_p, study.gains.k_v, kLoopNaturalFrequency,
      kLoopDampingRatio, study.sweep.amplitude, study.sweep.rate_hz);
}

std::string Explanation(const WavesStudy& study) {
  const model::Parameters& p = study.p;
  const double inertance = p.beta * (1 / (kVolumeFraction * p.V_ms) + 1 / ((1 - kVolumeFraction) * p.V_ms)) /
                           std::pow(2 * std::numbers::pi * kWaveHz, 2);
  const double bore = 0.125;  // in
  const double line_length = inertance / kOil * std::numbers::pi * bore * bore / 4;
  const double sound = std::sqrt(p.beta / kOil);
  return fmt::format(
      "The line's mode lies at {mode_hz:.1f} Hz with damping {mode_damping:.4f} (eigenvalues of the "
      "linearised model); the sweep finds its peak at {peak_hz:.1f} Hz, {peak_db:.1f} dB, in the closed "
      "loop. The motor's speed is sensed where the torque acts, and k_v damps the wave; the pressures are "
      "sensed at the other end of the line, and k_p drives it. With k_v as designed the loop is stable up to "
      "k_p = {k_p_limit:.3f} V/psi, {factor:.1f} times the design's; with ζ = .5 throughout, up to ω_n = "
      "{frequency_limit:.0f} rad/s. So the waves allow {frequency_ratio:.1f} times the paper's 150 rad/s, "
      "but no \"arbitrary placement\". Transducers at the pump would {at_pump} up to {most_factor} times the "
      "design's k_p. The damping is the least known number here: with half of it the limit is "
      "{low_damping_limit:.0f} rad/s, with twice {high_damping_limit:.0f}. Sampling and delay shift the "
      "phase: at 5 kHz with one tick of delay the limit is {sampled_k_p_limit:.3f} V/psi, confirmed over the "
      "stack: {growth_below:+.2f} 1/s measured at 95 % of it ({expected_below:+.2f} expected), "
      "{growth_above:+.2f} at 105 % ({expected_above:+.2f}). At 1 kHz the delay itself is the limit, at "
      "{slow_hz:.0f} Hz and {slow_k_p_limit:.3f} V/psi. The frequency varies as the square root of 1/V_p + "
      "1/(V_ms - V_p). As a line, {line_volume:.2f} in^3 and this inertance correspond to {line_length:.0f} "
      "in of {bore} in bore (oil of 0.85 kg/l); by the speed of sound, {sound:.0f} in/s, 300 Hz is a quarter "
      "wave of {quarter_wave:.0f} in.",
      fmt::arg("mode_hz", study.mode_hz), fmt::arg("mode_damping", study.mode_damping),
      fmt::arg("peak_hz", study.peak.frequency_hz), fmt::arg("peak_db", design::Decibels(study.peak.gain)),
      fmt::arg("k_p_limit", study.highest_k_p()), fmt::arg("factor", study.limits.gain.factor),
      fmt::arg("frequency_limit", study.limits.natural_frequency),
      fmt::arg("frequency_ratio", study.limits.natural_frequency / kLoopNaturalFrequency),
      fmt::arg("at_pump", study.at_pump.gain.factor < kMostFactor ? "not be stable" : "be stable"),
      fmt::arg("most_factor", kMostFactor),
      fmt::arg("low_damping_limit", study.by_damping[0].limits.natural_frequency),
      fmt::arg("high_damping_limit", study.by_damping[2].limits.natural_frequency),
      fmt::arg("sampled_k_p_limit", study.shipped().limits.gain.factor * study.gains.k_p),
      fmt::arg("growth_below", study.trials[0].growth), fmt::arg("expected_below", study.trials[0].expected),
      fmt::arg("growth_above", study.trials[1].growth), fmt::arg("expected_above", study.trials[1].expected),
      fmt::arg("slow_hz", study.slow().limits.gain.frequency_hz),
      fmt::arg("slow_k_p_limit", study.slow().limits.gain.factor * study.gains.k_p),
      fmt::arg("line_volume", kVolumeFraction * p.V_ms), fmt::arg("line_length", line_length),
      fmt::arg("bore", bore), fmt::arg("sound", sound), fmt::arg("quarter_wave", sound / (4 * kWaveHz)));
}

std::vector<Comparison> Comparisons(const WavesStudy& study) {
  return {{"natural frequency of the waves", "Hz", "about 300", kWaveHz, study.mode_hz,
           "expected: the effect's; the pump gives way a little"},
          {"damping of the waves, open loop", "", "", kWaveDamping, study.mode_damping,
           "expected: the line's; pump friction and leakage add"},
          {"peak of the swept sine", "Hz", "about 300", study.closed_pole.imag() / (2 * std::numbers::pi),
           study.peak.frequency_hz, "expected: the closed loop's pole"},
          {"highest stable k_p, k_v as designed, analog", "V/psi", "", page::kAutomatic, study.highest_k_p(),
           fmt::format("design: {:.4f}", study.gains.k_p)},
          {"highest stable ω_n, ζ = .5, analog", "rad/s", "", page::kAutomatic,
           study.limits.natural_frequency, "the paper's is 150"},
          {"growth at 95 % of the limit, 5 kHz", "1/s", "", study.trials[0].expected, study.trials[0].growth,
           "expected: eigenvalue of the sampled loop"},
          {"growth at 105 % of the limit, 5 kHz", "1/s", "", study.trials[1].expected, study.trials[1].growth,
           "the same"},
          {"largest difference from the linearised loop, gain", "dB", "", 0, study.worst_db, "6 to 600 Hz"},
          {"largest difference from the linearised loop, phase", "degrees", "", 0, study.worst_deg,
           "6 to 600 Hz"}};
}

json ByVolume(const WavesStudy& study) {
  json rows = json::array();
  for (const LineVariant& line : study.by_volume) {
    json row = Describe(line.limits, study.gains);
    row["volume_fraction"] = line.volume_fraction;
    row["line_volume_in3"] = line.volume_fraction * study.p.V_ms;
    row["mode_frequency_hz"] = line.mode_hz;
    row["closed_form_hz"] = line.closed_form_hz;
    rows.push_back(row);
  }
  return rows;
}

json ByDamping(const WavesStudy& study) {
  json rows = json::array();
  for (const LineVariant& line : study.by_damping) {
    json row = Describe(line.limits, study.gains);
    row["damping"] = line.damping;
    rows.push_back(row);
  }
  return rows;
}

std::vector<tables::Column> Columns(const WavesStudy& study) {
  tables::Column frequency{"frequency_hz", {}};
  tables::Column gain{"gain_db", {}};
  tables::Column phase{"phase_deg", design::PhasesDeg(study.swept.points)};
  tables::Column coherence{"coherence", {}};
  for (const design::ResponsePoint& point : study.swept.points) {
    frequency.values.push_back(point.frequency_hz);
    gain.values.push_back(design::Decibels(point.gain));
    coherence.values.push_back(point.coherence);
  }
  return {frequency, gain, phase, coherence};
}

json Numbers(const WavesStudy& study, const std::vector<tables::Column>& columns) {
  json numbers = {{"frequency_assumed_hz", kWaveHz},
                  {"volume_fraction", kVolumeFraction},
                  {"damping_assumed", kWaveDamping},
                  {"mode_frequency_hz", study.mode_hz},
                  {"mode_damping", study.mode_damping},
                  {"closed_loop_mode",
                   {{"frequency_hz", std::abs(study.closed_pole) / (2 * std::numbers::pi)},
                    {"damping", -study.closed_pole.real() / std::abs(study.closed_pole)}}},
                  {"peak_hz", study.peak.frequency_hz},
                  {"peak_gain_db", design::Decibels(study.peak.gain)},
                  {"k_p_V_per_psi", study.gains.k_p},
                  {"k_v_psi_s_per_rad", study.gains.k_v},
                  {"sensors_at_pump", Describe(study.at_pump, study.gains)},
                  {"by_damping", ByDamping(study)},
                  {"by_line_volume", ByVolume(study)},
                  {"linearised", {{"worst_error_db", study.worst_db}, {"worst_error_deg", study.worst_deg}}}};
  numbers.update(Describe(study.limits, study.gains));
  for (const SampledPressureLoop& one : study.sampled) {
    json row = Describe(one.limits, study.gains);
    row["rate_hz"] = std::round(1 / one.timing.interval);
    row["delay_ticks"] = one.timing.delay_ticks;
    numbers["sampled"].push_back(row);
  }
  for (const GainTrial& trial : study.trials) {
    numbers["time_check"].push_back({{"rate_hz", std::round(1 / study.shipped().timing.interval)},
                                     {"delay_ticks", study.shipped().timing.delay_ticks},
                                     {"part_of_limit", trial.factor},
                                     {"growth_per_s", trial.growth},
                                     {"expected_growth_per_s", trial.expected}});
  }
  for (const tables::Column& column : columns) numbers[column.name] = column.values;
  return numbers;
}

Picture BodePicture(const WavesStudy& study) {
  const pressure_ctrl::PressureGains& gains = study.gains;
  const design::LinearPressureLoop linear = study.swept_linear();
  const design::LinearPressureLoop rigid(LinearisedClamped(ShippedModel("table1")),
                                         {1 / study.sweep.rate_hz, 0});
  return {
      "",
      {.caption = fmt::format("Closed pressure loop with waves in the lines ({} Hz, damping {}), swept sine "
                              "of ±{} psi. Points: measured over the stack; line: the linearised loop, "
                              "within {:.2f} dB and {:.1f}°; dashed: without waves.",
                              kWaveHz, kWaveDamping, study.sweep.amplitude, study.worst_db, study.worst_deg),
       .panels = BodePanels(
           "Pressure loop with waves in the lines",
           {{"measured", study.swept.points, page::Stroke::kPoints, 0},
            {"linearised", Sampled(6, 600, [&](double hz) { return linear.ClosedGain(gains, hz); }),
             page::Stroke::kLine, 1},
            {"without waves", Sampled(6, 600, [&](double hz) { return rigid.ClosedGain(gains, hz); }),
             page::Stroke::kDashed, 2}},
           {{"paper: waves at 300 Hz", true, kWaveHz}}, -70)}};
}

// The real part of the wave's pole over k_p, followed from gain to gain.
page::Curve GrowthCurve(const std::string& label, const design::LinearPressureLoop& loop,
                        const pressure_ctrl::PressureGains& gains) {
  page::Curve curve = page::Line(label, {}, {}, -1);
  std::complex<double> wave = WavePole(loop, gains);
  for (int i = 1; i <= 150; ++i) {
    const double k_p = 0.1 * i * gains.k_p;
    const auto poles = loop.VisiblePoles({k_p, gains.k_v});
    wave = *std::min_element(poles.begin(), poles.end(), [&](std::complex<double> a, std::complex<double> b) {
      return std::abs(a - wave) < std::abs(b - wave);
    });
    curve.x.push_back(k_p);
    curve.y.push_back(wave.real() > -kShownDecay ? wave.real() : page::kAutomatic);
  }
  return curve;
}

Picture GainPicture(const WavesStudy& study) {
  const pressure_ctrl::PressureGains& gains = study.gains;
  const std::vector<page::Curve> growth = {
      GrowthCurve("analog", design::LinearPressureLoop(study.linear, {}), gains),
      GrowthCurve("5 kHz, one tick of delay",
                  design::LinearPressureLoop(study.linear, study.shipped().timing), gains),
      GrowthCurve("analog, transducers at the pump",
                  design::LinearPressureLoop(SensedAtPump(study.linear), {}), gains)};
  return {
      "-gain",
      {.caption = "Real part of the wave's pole as k_p grows, k_v as designed: above 0 the wave grows. "
                  "Below: the stack at 5 kHz with one tick of delay, just below and just above its limit, "
                  "after a step of 0.2 psi.",
       .panels = {{.title = "Gain that the waves allow",
                   .x = {.label = "k_p, V/psi", .min = 0},
                   .y = {.label = "growth of the wave, 1/s", .min = -kShownDecay, .max = 40},
                   .curves = growth,
                   .rules = {{"stable below", false, 0},
                             {fmt::format("design: {:.3f}", gains.k_p), true, gains.k_p}}},
                  TrialPanel(study.trials[0]),
                  TrialPanel(study.trials[1])}}};
}

Picture VolumePicture(const WavesStudy& study) {
  const double V_ms = study.p.V_ms;
  page::Curve closed_form = page::Line("closed form", {}, {}, 1);
  for (double fraction = 0.03; fraction <= 0.555; fraction += 0.005) {
    closed_form.x.push_back(fraction * V_ms);
    closed_form.y.push_back(ClosedFormHz(fraction));
  }
  page::Curve eigenvalues = page::Line("eigenvalue", {}, {}, 0, page::Stroke::kPoints);
  for (const LineVariant& line : study.by_volume) {
    eigenvalues.x.push_back(line.volume_fraction * V_ms);
    eigenvalues.y.push_back(line.mode_hz);
  }
  return {"-volume",
          {.caption = "Frequency of the waves over the volume on the pump's side of the line; the line "
                      "itself and V_ms stay the same.",
           .panels = {{.title = "Frequency and line volume",
                       .x = {.label = "volume at the pump, in^3", .min = 0, .max = 1.8},
                       .y = {.label = "frequency, Hz", .min = 0},
                       .curves = {closed_form, eigenvalues},
                       .rules = {{"paper: about 300 Hz", false, kWaveHz}}}}}};
}

}  // namespace

ExperimentResult RunWaves(const ExperimentOptions& options) {
  const WavesStudy study = StudyWaves(options);
  ExperimentResult result;
  result.conditions = Conditions(study);
  result.paper_says =
      "Two things limit the pressure loop: the torque limit, and pressure waves in the lines, which the "
      "model leaves out. Their natural frequency was measured to be about 300 Hz.";
  result.explanation = Explanation(study);
  result.comparisons = Comparisons(study);
  result.table.columns = Columns(study);
  result.numbers = JsonText(Numbers(study, result.table.columns));
  result.pictures = {BodePicture(study), GainPicture(study), VolumePicture(study)};
  options.progress(1);
  return result;
}

}  // namespace hydro::experiments
