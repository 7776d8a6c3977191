// The pressure waves in the lines, measured at about 300 Hz: where they show, and what gain they allow.
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "experiments/figures/catalogue.h"
#include "experiments/runs/shipped_models.h"
#include "experiments/studies/bode_case.h"
#include "experiments/studies/json_text.h"
#include "settings/model_file.h"

namespace hydro::experiments {
namespace {

using nlohmann::json;

constexpr double kNaturalFrequency = 150;  // rad/s, Figure 8
constexpr double kDampingRatio = 0.5;      // Figure 8
constexpr double kWaveHz = 300;            // the paper
constexpr double kVolumeFraction = 0.1;    // of V_ms on the pump's side of the line: ASSUMED
constexpr double kWaveDamping = 0.01;      // ASSUMED: the paper says nothing
constexpr double kInitialPressure = 1500;  // psi: leaks away slowly, both sides stay above p_3
constexpr double kOil = 7.95e-5;           // lbf s^2/in^4, 0.85 kg/l: ASSUMED, for the length of line only
constexpr double kTrialStep = 0.2;       // psi: small, so that a growing wave does not reach the torque limit
constexpr double kMostFactor = 200;      // on k_p
constexpr double kShownDecay = 100;      // 1/s
constexpr double kMostFrequency = 3000;  // rad/s

// Table 1 with waves. Without Coulomb friction: amplitudes at which the pump moves at 300 Hz against 4 in-lbf
// are beyond the motor.
model::ModelDescription WithWaves(double frequency_hz, double volume_fraction, double damping) {
  model::ModelDescription model = ShippedModel("table1");
  model.parameters.T_s = 0;
  model.effects.push_back(
      {"line.wave",
       {{"frequency", frequency_hz}, {"volume_fraction", volume_fraction}, {"damping", damping}},
       {}});
  return model;
}

model::LinearModel Linear(const model::ModelDescription& model) {
  const model::Equations equations(model, {.shaft = model::Shaft::kClamped});
  double state[model::kMaxStates];
  model::Mode mode;
  equations.Start(1000, state, &mode);
  return model::Linearise(equations, 0, 0, BothCompress(), state);
}

// The same with pressure transducers at the pump instead of the actuator.
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

// The wave that the loop sees, in the difference of the sides: the fastest of the visible poles.
std::complex<double> WavePole(const LinearPressureLoop& loop, const pressure_ctrl::PressureGains& gains) {
  std::complex<double> wave = 0;
  for (const std::complex<double> pole : loop.VisiblePoles(gains)) {
    if (pole.imag() > wave.imag()) wave = pole;
  }
  return wave;
}

// What a loop allows.
struct Limits {
  GainLimit gain;                // factor on the design's k_p with its k_v
  double natural_frequency = 0;  // rad/s, with both gains derived from it and zeta = .5
};
Limits FindLimits(const LinearPressureLoop& loop, const model::Parameters& p,
                  const pressure_ctrl::PressureGains& gains) {
  const auto stable = [&](double natural_frequency) {
    return loop.Growth(pressure_ctrl::DerivePressureGains(p, 0, natural_frequency, kDampingRatio, 2)) < 0;
  };
  double low = kNaturalFrequency / 3;
  double high = low;
  while (high < kMostFrequency && stable(high)) {
    low = high;
    high *= 1.02;
  }
  for (int i = 0; i < 40; ++i) {
    const double middle = 0.5 * (low + high);
    (stable(middle) ? low : high) = middle;
  }
  return {LargestStableFactor(loop, gains, kMostFactor), low};
}

json Describe(const Limits& limits, const pressure_ctrl::PressureGains& gains) {
  const bool limited = limits.gain.factor < kMostFactor;
  return {{"highest_stable_k_p_V_per_psi", limited ? json(limits.gain.factor * gains.k_p) : json(nullptr)},
          {"factor", limited ? json(limits.gain.factor) : json(nullptr)},
          {"oscillates_at_hz", limited ? json(limits.gain.frequency_hz) : json(nullptr)},
          {"highest_stable_natural_frequency_rad_s",
           limits.natural_frequency < kMostFrequency ? json(limits.natural_frequency) : json(nullptr)}};
}

// The loop over the stack beside its limit: how a wave grows or decays after a small step.
struct Trial {
  double factor = 0;  // of the limit
  std::vector<double> time;
  std::vector<double> dp;
  double growth = 0;    // 1/s, measured
  double expected = 0;  // 1/s, the pole's real part
};
Trial RunTrial(const model::ModelDescription& model, const LoopTiming& timing,
               const pressure_ctrl::PressureGains& gains, double factor, const StackRunner& run_stack) {
  constexpr double kDuration = 1.5;
  const double rate = 1 / timing.interval;
  const tables::Table table =
      run_stack({fmt::format("waves-{}-of-limit", factor),
                 fmt::format(R"([model]
file = "model.toml"
shaft = "clamped"
initial_pressure_psi = {}
[time]
mode = "lockstep"
duration_s = {}
[plant]
rate_hz = {}
command_delay_ticks = {}
[pressure]
k_p = {}
k_v = {}
[position]
sample_interval_s = {}
[reference]
signal = "pressure"
kind = "steps"
steps = [[0.1, {}]]
[limits]
pressure_psi = inf
)",
                             kInitialPressure, kDuration, std::round(rate), timing.delay_ticks, gains.k_p,
                             gains.k_v, timing.interval, kTrialStep),
                 settings::FormatModel(model)});
  Trial trial = {factor, table.Find("time_s")->values, table.Find("p2_psi")->values, 0, 0};
  const std::vector<double>& p1 = table.Find("p1_psi")->values;
  for (size_t i = 0; i < p1.size(); ++i) trial.dp[i] -= p1[i];
  trial.expected = LinearPressureLoop(Linear(model), timing).LeastDampedPole(gains).real();
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

page::Panel TrialPanel(const Trial& trial) {
  return {.title = fmt::format("k_p at {:.0f} % of its limit: {:+.1f} 1/s measured, {:+.1f} 1/s expected",
                               100 * trial.factor, trial.growth, trial.expected),
          .x = {.label = "time, s", .min = 0},
          .y = {.label = "dp, psi"},
          .curves = {page::Line("", trial.time, trial.dp, 0)},
          .notes = {},
          .rules = {}};
}

}  // namespace

ExperimentResult RunWaves(const ExperimentOptions& options) {
  const model::Parameters p = ShippedModel("table1").parameters;
  const pressure_ctrl::PressureGains gains =
      pressure_ctrl::DerivePressureGains(p, 0, kNaturalFrequency, kDampingRatio, 2);
  const model::ModelDescription model = WithWaves(kWaveHz, kVolumeFraction, kWaveDamping);
  const model::LinearModel linear = Linear(model);
  const LinearPressureLoop analog(linear, {});
  const std::complex<double> open_pole = WavePole(analog, {});
  const std::complex<double> closed_pole = WavePole(analog, gains);
  const double mode_hz = std::abs(open_pole) / (2 * std::numbers::pi);
  const double mode_damping = -open_pole.real() / std::abs(open_pole);
  const Limits limits = FindLimits(analog, p, gains);
  const Limits at_pump = FindLimits(LinearPressureLoop(SensedAtPump(linear), {}), p, gains);

  struct SampledLoop {
    LoopTiming timing;
    Limits limits;
  };
  std::vector<SampledLoop> sampled = {
      {{1e-4, 0}, {}}, {{1e-4, 1}, {}}, {{2e-4, 0}, {}}, {{2e-4, 1}, {}}, {{1e-3, 1}, {}}};
  for (SampledLoop& one : sampled) one.limits = FindLimits(LinearPressureLoop(linear, one.timing), p, gains);
  const SampledLoop& shipped = sampled[3];  // 5 kHz and one tick of delay, as config/paper.toml
  const SampledLoop& slow = sampled[4];
  options.progress(0.2);

  // The sweep, at the design's gains.
  PressureSweep sweep{.name = "waves", .model = model, .gains = gains, .amplitude = 30};
  sweep.initial_pressure = kInitialPressure;
  sweep.rate_hz = 10000;
  sweep.bands = {{6, 100, 5, 1.5, 16}, {100, 250, 5, 2, 64}, {250, 350, 6, 4, 400}, {350, 600, 5, 2, 64}};
  const SweptPressureLoop swept = RunPressureSweep(sweep, options.run_stack);
  const LinearPressureLoop swept_linear(linear, {1 / sweep.rate_hz, 0});
  double worst_db = 0;
  double worst_deg = 0;
  ResponsePoint peak;
  for (const ResponsePoint& point : swept.points) {
    const std::complex<double> error = point.gain / swept_linear.ClosedGain(gains, point.frequency_hz);
    worst_db = std::max(worst_db, std::abs(Decibels(error)));
    worst_deg = std::max(worst_deg, std::abs(std::arg(error)) * 180 / std::numbers::pi);
    if (point.frequency_hz > 200 && std::abs(point.gain) > std::abs(peak.gain)) peak = point;
  }
  options.progress(0.6);

  std::vector<Trial> trials;
  for (const double beside : {0.95, 1.05}) {
    trials.push_back(RunTrial(model, shipped.timing,
                              {beside * shipped.limits.gain.factor * gains.k_p, gains.k_v}, beside,
                              options.run_stack));
  }
  options.progress(0.8);

  // The same line between other volumes, and other dampings.
  json by_volume = json::array();
  page::Curve closed_form = page::Line("closed form", {}, {}, 1);
  page::Curve eigenvalues = page::Line("eigenvalue", {}, {}, 0, page::Stroke::kPoints);
  const auto frequency_of = [&](double fraction) {  // w^2 goes with 1/V_p + 1/(V_ms - V_p)
    return kWaveHz * std::sqrt(kVolumeFraction * (1 - kVolumeFraction) / (fraction * (1 - fraction)));
  };
  for (const double fraction : {0.03, 0.05, 0.1, 0.15, 0.2, 0.3, 0.4, 0.5}) {
    const double hz = frequency_of(fraction);
    // The line's resistance is kept, too: its damping of the mode goes as 1/w.
    const LinearPressureLoop loop(Linear(WithWaves(hz, fraction, kWaveDamping * kWaveHz / hz)), {});
    const double found = std::abs(WavePole(loop, {})) / (2 * std::numbers::pi);
    const Limits allowed = FindLimits(loop, p, gains);
    json row = Describe(allowed, gains);
    row["volume_fraction"] = fraction;
    row["line_volume_in3"] = fraction * p.V_ms;
    row["mode_frequency_hz"] = found;
    row["closed_form_hz"] = hz;
    by_volume.push_back(row);
    eigenvalues.x.push_back(fraction * p.V_ms);
    eigenvalues.y.push_back(found);
  }
  for (double fraction = 0.03; fraction <= 0.555; fraction += 0.005) {
    closed_form.x.push_back(fraction * p.V_ms);
    closed_form.y.push_back(frequency_of(fraction));
  }
  json by_damping = json::array();
  for (const double damping : {0.005, 0.01, 0.02, 0.05}) {
    const LinearPressureLoop loop(Linear(WithWaves(kWaveHz, kVolumeFraction, damping)), {});
    json row = Describe(FindLimits(loop, p, gains), gains);
    row["damping"] = damping;
    by_damping.push_back(row);
  }
  const double inertance = p.beta * (1 / (kVolumeFraction * p.V_ms) + 1 / ((1 - kVolumeFraction) * p.V_ms)) /
                           std::pow(2 * std::numbers::pi * kWaveHz, 2);
  const double bore = 0.125;  // in
  const double line_length = inertance / kOil * std::numbers::pi * bore * bore / 4;
  const double sound = std::sqrt(p.beta / kOil);

  const double highest_k_p = limits.gain.factor * gains.k_p;
  ExperimentResult result;
  result.conditions = fmt::format(
      "Table 1 with line.wave: frequency {} Hz, {:.0f} % of V_ms on the pump's side of the line, damping {} "
      "(the latter two ASSUMED), clamped at α = 0, both sides compressing. Coulomb friction left out: at 300 "
      "Hz it would hold the pump. Gains k_p = {:.4f} V/psi, k_v = {:.2f} psi s/rad (ω_n = {} rad/s, ζ = {}). "
      "Swept sine of ±{} psi, 6 to 600 Hz, over the stack at {} Hz without command delay.",
      kWaveHz, 100 * kVolumeFraction, kWaveDamping, gains.k_p, gains.k_v, kNaturalFrequency, kDampingRatio,
      sweep.amplitude, sweep.rate_hz);
  result.paper_says =
      "Two things limit the pressure loop: the torque limit, and pressure waves in the lines, which the "
      "model leaves out. Their natural frequency was measured to be about 300 Hz.";
  result.explanation = fmt::format(
      "The line's mode lies at {:.1f} Hz with damping {:.4f} (eigenvalues of the linearised model); the "
      "sweep finds its peak at {:.1f} Hz, {:.1f} dB, in the closed loop. The motor's speed is sensed where "
      "the torque acts, and k_v damps the wave; the pressures are sensed at the other end of the line, and "
      "k_p drives it. With k_v as designed the loop is stable up to k_p = {:.3f} V/psi, {:.1f} times the "
      "design's; with ζ = .5 throughout, up to ω_n = {:.0f} rad/s. So the waves allow {:.1f} times the "
      "paper's 150 rad/s, and no \"arbitrary placement\". Transducers at the pump would {} up to {} times "
      "the design's k_p. The damping is the least known number here: with half of it the limit is {:.0f} "
      "rad/s, with twice {:.0f}. Sampling and delay turn the phase: at 5 kHz with one tick of delay the "
      "limit is "
      "{:.3f} V/psi, confirmed over the stack: {:+.2f} 1/s measured at 95 % of it ({:+.2f} expected), "
      "{:+.2f} at 105 % ({:+.2f}). At 1 kHz the delay itself is the limit, at {:.0f} Hz and {:.3f} V/psi. "
      "The frequency goes with the square root of 1/V_p + 1/(V_ms - V_p). As a line, {:.2f} in^3 and this "
      "inertance are {:.0f} in of {} in bore (oil of 0.85 kg/l); by the speed of sound, {:.0f} in/s, 300 Hz "
      "is a quarter wave of {:.0f} in.",
      mode_hz, mode_damping, peak.frequency_hz, Decibels(peak.gain), highest_k_p, limits.gain.factor,
      limits.natural_frequency, limits.natural_frequency / kNaturalFrequency,
      at_pump.gain.factor < kMostFactor ? "not be stable" : "be stable", kMostFactor,
      by_damping[0].at("highest_stable_natural_frequency_rad_s").get<double>(),
      by_damping[2].at("highest_stable_natural_frequency_rad_s").get<double>(),
      shipped.limits.gain.factor * gains.k_p, trials[0].growth, trials[0].expected, trials[1].growth,
      trials[1].expected, slow.limits.gain.frequency_hz, slow.limits.gain.factor * gains.k_p,
      kVolumeFraction * p.V_ms, line_length, bore, sound, sound / (4 * kWaveHz));

  result.comparisons = {
      {"natural frequency of the waves", "Hz", "about 300", kWaveHz, mode_hz,
       "expected: the effect's; the pump gives way a little"},
      {"damping of the waves, open loop", "", "", kWaveDamping, mode_damping,
       "expected: the line's; pump friction and leakage add"},
      {"peak of the swept sine", "Hz", "about 300", closed_pole.imag() / (2 * std::numbers::pi),
       peak.frequency_hz, "expected: the closed loop's pole"},
      {"highest stable k_p, k_v as designed, analog", "V/psi", "", page::kAutomatic, highest_k_p,
       fmt::format("design: {:.4f}", gains.k_p)},
      {"highest stable ω_n, ζ = .5, analog", "rad/s", "", page::kAutomatic, limits.natural_frequency,
       "the paper's is 150"},
      {"growth at 95 % of the limit, 5 kHz", "1/s", "", trials[0].expected, trials[0].growth,
       "expected: eigenvalue of the sampled loop"},
      {"growth at 105 % of the limit, 5 kHz", "1/s", "", trials[1].expected, trials[1].growth, "the same"},
      {"largest difference from the linearised loop, gain", "dB", "", 0, worst_db, "6 to 600 Hz"},
      {"largest difference from the linearised loop, phase", "degrees", "", 0, worst_deg, "6 to 600 Hz"},
  };

  json numbers = {{"frequency_assumed_hz", kWaveHz},
                  {"volume_fraction", kVolumeFraction},
                  {"damping_assumed", kWaveDamping},
                  {"mode_frequency_hz", mode_hz},
                  {"mode_damping", mode_damping},
                  {"closed_loop_mode",
                   {{"frequency_hz", std::abs(closed_pole) / (2 * std::numbers::pi)},
                    {"damping", -closed_pole.real() / std::abs(closed_pole)}}},
                  {"peak_hz", peak.frequency_hz},
                  {"peak_gain_db", Decibels(peak.gain)},
                  {"k_p_V_per_psi", gains.k_p},
                  {"k_v_psi_s_per_rad", gains.k_v},
                  {"sensors_at_pump", Describe(at_pump, gains)},
                  {"by_damping", by_damping},
                  {"by_line_volume", by_volume},
                  {"linearised", {{"worst_error_db", worst_db}, {"worst_error_deg", worst_deg}}}};
  numbers.update(Describe(limits, gains));
  for (const SampledLoop& one : sampled) {
    json row = Describe(one.limits, gains);
    row["rate_hz"] = std::round(1 / one.timing.interval);
    row["delay_ticks"] = one.timing.delay_ticks;
    numbers["sampled"].push_back(row);
  }
  for (const Trial& trial : trials) {
    numbers["time_check"].push_back({{"rate_hz", std::round(1 / shipped.timing.interval)},
                                     {"delay_ticks", shipped.timing.delay_ticks},
                                     {"part_of_limit", trial.factor},
                                     {"growth_per_s", trial.growth},
                                     {"expected_growth_per_s", trial.expected}});
  }
  tables::Column frequency{"frequency_hz", {}};
  tables::Column gain{"gain_db", {}};
  tables::Column phase{"phase_deg", PhasesDeg(swept.points)};
  tables::Column coherence{"coherence", {}};
  for (const ResponsePoint& point : swept.points) {
    frequency.values.push_back(point.frequency_hz);
    gain.values.push_back(Decibels(point.gain));
    coherence.values.push_back(point.coherence);
  }
  result.table.columns = {frequency, gain, phase, coherence};
  for (const tables::Column& column : result.table.columns) numbers[column.name] = column.values;
  result.numbers = JsonText(numbers);

  const LinearPressureLoop rigid(Linear(ShippedModel("table1")), {1 / sweep.rate_hz, 0});
  result.pictures.push_back(
      {"",
       {.caption = fmt::format("Closed pressure loop with waves in the lines ({} Hz, damping {}), swept sine "
                               "of ±{} psi. Points: measured over the stack; line: the linearised loop, "
                               "within {:.2f} dB and {:.1f}°; dashed: without waves.",
                               kWaveHz, kWaveDamping, sweep.amplitude, worst_db, worst_deg),
        .panels = BodePanels(
            "Pressure loop with waves in the lines",
            {{"measured", swept.points, page::Stroke::kPoints, 0},
             {"linearised", Sampled(6, 600, [&](double hz) { return swept_linear.ClosedGain(gains, hz); }),
              page::Stroke::kLine, 1},
             {"without waves", Sampled(6, 600, [&](double hz) { return rigid.ClosedGain(gains, hz); }),
              page::Stroke::kDashed, 2}},
            {{"paper: waves at 300 Hz", true, kWaveHz}}, -70),
        .drawing = ""}});
  std::vector<page::Curve> growth;
  const auto add = [&](const std::string& label, const LinearPressureLoop& loop) {
    page::Curve curve = page::Line(label, {}, {}, -1);
    std::complex<double> wave = WavePole(loop, gains);
    for (int i = 1; i <= 150; ++i) {  // the pole is followed from gain to gain
      const double k_p = 0.1 * i * gains.k_p;
      const auto poles = loop.VisiblePoles({k_p, gains.k_v});
      wave =
          *std::min_element(poles.begin(), poles.end(), [&](std::complex<double> a, std::complex<double> b) {
            return std::abs(a - wave) < std::abs(b - wave);
          });
      curve.x.push_back(k_p);
      curve.y.push_back(wave.real() > -kShownDecay ? wave.real() : page::kAutomatic);
    }
    growth.push_back(std::move(curve));
  };
  add("analog", analog);
  add("5 kHz, one tick of delay", LinearPressureLoop(linear, shipped.timing));
  add("analog, transducers at the pump", LinearPressureLoop(SensedAtPump(linear), {}));
  result.pictures.push_back(
      {"-gain",
       {.caption = "Real part of the wave's pole as k_p grows, k_v as designed: above 0 the wave grows. "
                   "Below: the stack at 5 kHz with one tick of delay, just below and just above its limit, "
                   "after a step of 0.2 psi.",
        .panels = {{.title = "What gain the waves allow",
                    .x = {.label = "k_p, V/psi", .min = 0},
                    .y = {.label = "growth of the wave, 1/s", .min = -kShownDecay, .max = 40},
                    .curves = growth,
                    .notes = {},
                    .rules = {{"stable below", false, 0},
                              {fmt::format("design: {:.3f}", gains.k_p), true, gains.k_p}}},
                   TrialPanel(trials[0]),
                   TrialPanel(trials[1])},
        .drawing = ""}});
  result.pictures.push_back({"-volume",
                             {.caption = "Frequency of the waves by the volume on the pump's side of the "
                                         "line, the line itself and V_ms kept.",
                              .panels = {{.title = "Frequency and line volume",
                                          .x = {.label = "volume at the pump, in^3", .min = 0, .max = 1.8},
                                          .y = {.label = "frequency, Hz", .min = 0},
                                          .curves = {closed_form, eigenvalues},
                                          .notes = {},
                                          .rules = {{"paper: about 300 Hz", false, kWaveHz}}}},
                              .drawing = ""}});
  options.progress(1);
  return result;
}

}  // namespace hydro::experiments
