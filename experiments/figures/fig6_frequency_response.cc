// Figure 6: frequency response of the closed pressure loop, arm clamped at mid-stroke.
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "experiments/figures/catalogue.h"
#include "experiments/runs/pressure_loop_run.h"
#include "experiments/runs/shipped_models.h"
#include "experiments/studies/bode_case.h"
#include "experiments/studies/experiment.h"

namespace hydro::experiments {
namespace {

using nlohmann::json;

constexpr double kFitToHz = 60;
constexpr double kFigure6ShownToHz = 100;
// psi, amplitudes of a reference about zero. The first is the figure's own.
constexpr double kAmplitudes[] = {60, 10, 20, 30, 100, 300};

struct Cases {
  std::vector<BodeCase> about_zero;  // in the order of kAmplitudes
  BodeCase no_friction;              // T_s = 0, both sides compress
  BodeCase one_sided;                // about 1000 psi, side 1 at p_3
  BodeCase one_sided_gains;          // the same, with gains designed for it
  BodeCase pumped_up;                // about 300 psi, with an amplitude that lets side 1 ride above p_3

  template <typename Self>
  static auto List(Self& self) {
    std::vector<decltype(&self.no_friction)> list;
    for (auto& one : self.about_zero) list.push_back(&one);
    list.insert(list.end(), {&self.no_friction, &self.one_sided, &self.one_sided_gains, &self.pumped_up});
    return list;
  }
  std::vector<BodeCase*> all() { return List(*this); }
  std::vector<const BodeCase*> all() const { return List(*this); }
};

Cases MakeCases(const model::ModelDescription& table1, const pressure_ctrl::PressureGains& two_sided,
                const pressure_ctrl::PressureGains& one_sided) {
  Cases cases;
  const auto make = [&](const std::string& key, const std::string& title, const model::Mode& mode) {
    BodeCase made;
    made.key = key;
    made.title = title;
    made.mode = mode;
    made.sweep.name = "fig6-" + key;
    made.sweep.model = table1;
    made.sweep.gains = two_sided;
    return made;
  };
  for (const double amplitude : kAmplitudes) {
    cases.about_zero.push_back(make(fmt::format("about_zero_{}", amplitude),
                                    fmt::format("±{} psi about zero", amplitude), BothCompress()));
    cases.about_zero.back().sweep.amplitude = amplitude;
  }
  cases.no_friction = make("no_friction", "T_s = 0, both sides compress", BothCompress());
  cases.no_friction.linear = true;
  PressureSweep& free = cases.no_friction.sweep;
  free.model.parameters.T_s = 0;
  free.amplitude = 30;
  free.initial_pressure = 1500;  // leaks away at (beta/V_ms) c_E = .51/s: above p_3 for the whole sweep
  free.bands = {{1, 6, 7, 4}, {6, 100, 7, 2}};
  cases.one_sided = make("one_sided", "side 1 held at p_3", Side1Held());
  cases.one_sided.linear = true;
  cases.one_sided.sweep.offset = 1000;
  cases.one_sided.sweep.amplitude = 4;
  cases.one_sided.sweep.rest_s = 3;
  cases.one_sided_gains = cases.one_sided;
  cases.one_sided_gains.key = "one_sided_own_gains";
  cases.one_sided_gains.title = "side 1 held at p_3, gains designed for it";
  cases.one_sided_gains.sweep.name = "fig6-one_sided_own_gains";
  cases.one_sided_gains.sweep.gains = one_sided;
  cases.one_sided_gains.sweep.amplitude = 3;
  cases.pumped_up = make("about_300", "±50 psi about 300 psi", BothCompress());
  cases.pumped_up.sweep.offset = 300;
  cases.pumped_up.sweep.amplitude = 50;
  cases.pumped_up.sweep.rest_s = 3;
  return cases;
}

BodeCurve Measured(const BodeCase& bode_case, int colour) {
  return {bode_case.title, bode_case.swept.points, page::Stroke::kPoints, colour};
}

BodeCurve Predicted(const BodeCase& bode_case, const std::string& label, page::Stroke stroke, int colour) {
  return PredictedCurve(bode_case, label, kFigure6ShownToHz, stroke, colour);
}

// On a sine of the motor's speed, Coulomb friction acts like viscous friction 4 T_s/(pi speed) (describing
// function). At omega_n the speed is k_1 k_p A/B, with B all the viscous friction, so B, and with it zeta,
// grows by 1/(1 - 4 T_s/(pi k_1 k_p A)).
double DampingWithFriction(const model::Parameters& p, const pressure_ctrl::PressureGains& gains,
                           double damping_ratio, double amplitude) {
  return damping_ratio / (1 - 4 * p.T_s / (std::numbers::pi * p.k_1 * gains.k_p * amplitude));
}

struct MidStrokeStudy {
  model::Parameters p;
  pressure_ctrl::PressureGains two_sided, one_sided;
  Cases cases;
  double worst_db = 0;  // differences from the linearised loop, over the cases that stay linear
  double worst_deg = 0;

  // In closed form.
  design::SecondOrderModel design = {1, kLoopNaturalFrequency, kLoopDampingRatio, 0};
  double sticking = 0;     // psi; nothing moves at smaller amplitudes
  double figure_zeta = 0;  // the design's plus friction's, at the figure's amplitude
  pressure_ctrl::SecondOrder one_sided_rule;
  double followed = 0;  // psi, the amplitude that the motor's torque allows at kPaperBandwidthHz

  const BodeCase& figure() const { return cases.about_zero.front(); }
  const BodeCase& small() const { return cases.about_zero[1]; }
  const BodeCase& large() const { return cases.about_zero.back(); }
};

void SolveInClosedForm(MidStrokeStudy* study) {
  const model::Parameters& p = study->p;
  study->sticking = p.T_s / (p.k_1 * study->two_sided.k_p);
  study->figure_zeta =
      DampingWithFriction(p, study->two_sided, kLoopDampingRatio, study->figure().sweep.amplitude);
  study->one_sided_rule = pressure_ctrl::PressureLoopDynamics(p, 0, study->two_sided, 1);
  // Without help from the feedback, well above omega_n: J w^2 dp/s is torque, with s in psi per rad.
  const double stiffness = 2 * p.beta * p.D / p.V_ms;
  const double w = 2 * std::numbers::pi * kPaperBandwidthHz;
  study->followed = p.T_pmax * stiffness / (p.J * w * w);
}

MidStrokeStudy RunMidStrokeStudy(const ExperimentOptions& options) {
  const model::ModelDescription table1 = ShippedModel("table1");
  MidStrokeStudy study;
  study.p = table1.parameters;
  study.two_sided =
      pressure_ctrl::DerivePressureGains(study.p, 0, kLoopNaturalFrequency, kLoopDampingRatio, 2);
  study.one_sided =
      pressure_ctrl::DerivePressureGains(study.p, 0, kLoopNaturalFrequency, kLoopDampingRatio, 1);
  study.cases = MakeCases(table1, study.two_sided, study.one_sided);
  const std::vector<BodeCase*> all = study.cases.all();
  for (size_t i = 0; i < all.size(); ++i) {
    Evaluate(all[i], kFitToHz, options.run_stack);
    options.progress(static_cast<double>(i + 1) / static_cast<double>(all.size()));
    if (!all[i]->linear) continue;
    study.worst_db = std::max(study.worst_db, all[i]->worst_error_db);
    study.worst_deg = std::max(study.worst_deg, all[i]->worst_error_deg);
  }
  SolveInClosedForm(&study);
  return study;
}

std::string Conditions(const MidStrokeStudy& study) {
  return fmt::format(
      "Table 1, clamped at α = 0; eq. (16) without feed-forward, k_p = {:.4f} V/psi and k_v = {:.2f} psi "
      "s/rad (ω_n = {} rad/s, ζ = {}, both sides compressing). The reference is a sine of constant amplitude "
      "swept from {} to {} Hz in two runs of {} s over the stack at {} Hz without command delay. Gain and "
      "coherence by Welch's cross-spectra (H1). Bandwidth: 3 dB below the gain at low frequencies.",
      study.two_sided.k_p, study.two_sided.k_v, kLoopNaturalFrequency, kLoopDampingRatio, 0.25, 140,
      kTwoDecades[0].duration_s, study.figure().sweep.rate_hz);
}

std::string Explanation(const MidStrokeStudy& study) {
  const Cases& cases = study.cases;
  return fmt::format(
      "The paper prints neither amplitude nor mean of its reference. Here it is ±{amplitude} psi about zero, "
      "the largest amplitude tried at which the motor does not saturate (largest torque {largest_torque:.1f} "
      "of {torque_limit} in-lbf). From p_3 on, the valves let oil in at each swing until both sides stay "
      "above p_3, so both compress {both_percent:.0f} % of the time, and the two-sided design holds: ω_n = "
      "{omega:.0f} rad/s, ζ = {zeta:.2f}, {bandwidth:.1f} Hz. The design itself has {design_bandwidth:.1f} "
      "Hz; it leaves out Coulomb friction, which damps a sine of amplitude A by the factor 1/(1 - (4/π) "
      "T_s/(k_1 k_p A)): ζ = {expected_zeta:.2f}. At ±{small_amplitude} psi it dominates (gain "
      "{small_gain:.2f} at low frequency; below {sticking:.1f} psi = T_s/(k_1 k_p) nothing moves); without "
      "it the fit gives ω_n = {no_friction_omega:.1f} and ζ = {no_friction_zeta:.3f}. At ±{large_amplitude} "
      "psi the motor saturates {saturated_percent:.0f} % of the time and only {large_bandwidth:.1f} Hz "
      "remain: at 32 Hz, 40 in-lbf accelerate the pump enough for {followed:.0f} psi and no more. ±30, ±60 "
      "and ±100 psi give {bandwidth_30:.1f}, {bandwidth:.1f} and {bandwidth_100:.1f} Hz: amplitudes of this "
      "order fit the paper's figure. About {offset} psi, with ±{one_sided_amplitude} psi, the pump creeps "
      "forward to make up for leakage and never reverses, side 1 stays at p_3, and the same gains give "
      "{one_sided_omega:.1f} rad/s, {one_sided_zeta:.3f} and {one_sided_bandwidth:.1f} Hz; gains for one "
      "side ({k_p:.3f}, {k_v:.2f}) restore {restored_omega:.1f} rad/s and {restored_bandwidth:.1f} Hz.",
      fmt::arg("amplitude", study.figure().sweep.amplitude),
      fmt::arg("largest_torque", study.figure().swept.largest_torque),
      fmt::arg("torque_limit", study.p.T_pmax),
      fmt::arg("both_percent", 100 * study.figure().swept.both_compress_fraction),
      fmt::arg("omega", study.figure().fit.model.natural_frequency),
      fmt::arg("zeta", study.figure().fit.model.damping_ratio),
      fmt::arg("bandwidth", study.figure().bandwidth_hz),
      fmt::arg("design_bandwidth", study.design.BandwidthHz()), fmt::arg("expected_zeta", study.figure_zeta),
      fmt::arg("small_amplitude", study.small().sweep.amplitude),
      fmt::arg("small_gain", study.small().low_gain), fmt::arg("sticking", study.sticking),
      fmt::arg("no_friction_omega", cases.no_friction.fit.model.natural_frequency),
      fmt::arg("no_friction_zeta", cases.no_friction.fit.model.damping_ratio),
      fmt::arg("large_amplitude", study.large().sweep.amplitude),
      fmt::arg("saturated_percent", 100 * study.large().swept.saturated_fraction),
      fmt::arg("large_bandwidth", study.large().bandwidth_hz), fmt::arg("followed", study.followed),
      fmt::arg("bandwidth_30", cases.about_zero[3].bandwidth_hz),
      fmt::arg("bandwidth_100", cases.about_zero[4].bandwidth_hz),
      fmt::arg("offset", cases.one_sided.sweep.offset),
      fmt::arg("one_sided_amplitude", cases.one_sided.sweep.amplitude),
      fmt::arg("one_sided_omega", cases.one_sided.fit.model.natural_frequency),
      fmt::arg("one_sided_zeta", cases.one_sided.fit.model.damping_ratio),
      fmt::arg("one_sided_bandwidth", cases.one_sided.bandwidth_hz), fmt::arg("k_p", study.one_sided.k_p),
      fmt::arg("k_v", study.one_sided.k_v),
      fmt::arg("restored_omega", cases.one_sided_gains.fit.model.natural_frequency),
      fmt::arg("restored_bandwidth", cases.one_sided_gains.bandwidth_hz));
}

std::vector<Comparison> Comparisons(const MidStrokeStudy& study) {
  const Cases& cases = study.cases;
  const BodeCase& none = cases.no_friction;
  const BodeCase& figure = study.figure();
  return {
      {"bandwidth (-3 dB)", "Hz", "about 32", study.design.BandwidthHz(), figure.bandwidth_hz,
       "expected: closed form for ω_n = 150, ζ = .5"},
      {"natural frequency of the fit", "rad/s", "roughly 150", kLoopNaturalFrequency,
       figure.fit.model.natural_frequency, ""},
      {"damping ratio of the fit", "", "roughly .5", study.figure_zeta, figure.fit.model.damping_ratio,
       "expected: .5 and Coulomb friction's describing function"},
      {"natural frequency, T_s = 0, both sides compress", "rad/s", "", kLoopNaturalFrequency,
       none.fit.model.natural_frequency, ""},
      {"damping ratio, T_s = 0, both sides compress", "", "", kLoopDampingRatio, none.fit.model.damping_ratio,
       "holding the voltage for 0.2 ms accounts for the difference"},
      {"bandwidth, T_s = 0, both sides compress", "Hz", "", study.design.BandwidthHz(), none.bandwidth_hz,
       ""},
      {"natural frequency, side 1 held at p_3", "rad/s", "", study.one_sided_rule.natural_frequency,
       cases.one_sided.fit.model.natural_frequency, "expected: 150/√2"},
      {"damping ratio, side 1 held at p_3", "", "", study.one_sided_rule.damping_ratio,
       cases.one_sided.fit.model.damping_ratio, "expected: .5 √2"},
      {"bandwidth, side 1 held at p_3", "Hz", "",
       design::SecondOrderModel{1, study.one_sided_rule.natural_frequency, study.one_sided_rule.damping_ratio,
                                0}
           .BandwidthHz(),
       cases.one_sided.bandwidth_hz, ""},
      {"natural frequency, side 1 held at p_3, gains designed for it", "rad/s", "", kLoopNaturalFrequency,
       cases.one_sided_gains.fit.model.natural_frequency, ""},
      {"bandwidth at ±300 psi", "Hz", "", page::kAutomatic, study.large().bandwidth_hz,
       "the motor's torque limit"},
      {"largest difference from the linearised loop, gain", "dB", "", 0, study.worst_db,
       "in the cases without friction's switching"},
      {"largest difference from the linearised loop, phase", "degrees", "", 0, study.worst_deg, "the same"}};
}

Finding GainsFinding(const MidStrokeStudy& study) {
  const Cases& cases = study.cases;
  const BodeCase& none = cases.no_friction;
  return {
      4, "The gains k_p and k_v of eq. (16) are not printed; they were chosen experimentally.",
      fmt::format(
          "ω_n = 150 rad/s and ζ = .5 of Figure 8 give k_p = {two_sided_k_p:.4f} V/psi, k_v = "
          "{two_sided_k_v:.2f} psi s/rad when both sides compress and {one_sided_k_p:.3f}, "
          "{one_sided_k_v:.2f} when one side is held at p_3. With the first pair the swept sine measures "
          "{both_omega:.1f} rad/s, {both_zeta:.3f} with both sides compressing (T_s = 0) and {one_omega:.1f} "
          "rad/s, {one_zeta:.3f} with one; with the second pair one side gives {own_omega:.1f} rad/s, "
          "{own_zeta:.3f}. Viscous friction b is {viscous_percent:.1f} % of the damping.",
          fmt::arg("two_sided_k_p", study.two_sided.k_p), fmt::arg("two_sided_k_v", study.two_sided.k_v),
          fmt::arg("one_sided_k_p", study.one_sided.k_p), fmt::arg("one_sided_k_v", study.one_sided.k_v),
          fmt::arg("both_omega", none.fit.model.natural_frequency),
          fmt::arg("both_zeta", none.fit.model.damping_ratio),
          fmt::arg("one_omega", cases.one_sided.fit.model.natural_frequency),
          fmt::arg("one_zeta", cases.one_sided.fit.model.damping_ratio),
          fmt::arg("own_omega", cases.one_sided_gains.fit.model.natural_frequency),
          fmt::arg("own_zeta", cases.one_sided_gains.fit.model.damping_ratio),
          fmt::arg("viscous_percent",
                   100 * study.p.b / (study.p.b + study.p.k_1 * study.two_sided.k_p * study.two_sided.k_v))),
      "Gains are derived from ω_n, ζ and the number of compressed sides (pressure.compressed_sides), by "
      "default two; both modes are shown."};
}

json Numbers(const MidStrokeStudy& study) {
  json numbers = CasesJson(study.cases.all());
  numbers["paper_bandwidth_hz"] = kPaperBandwidthHz;
  numbers["design_bandwidth_hz"] = study.design.BandwidthHz();
  numbers["damping_ratio_with_friction_expected"] = study.figure_zeta;
  numbers["sticks_below_psi"] = study.sticking;
  numbers["amplitude_that_torque_allows_at_32_hz_psi"] = study.followed;
  numbers["gains"] = {
      {"two_sided", {{"k_p_V_per_psi", study.two_sided.k_p}, {"k_v_psi_s_per_rad", study.two_sided.k_v}}},
      {"one_sided", {{"k_p_V_per_psi", study.one_sided.k_p}, {"k_v_psi_s_per_rad", study.one_sided.k_v}}}};
  numbers["linearised"] = {{"worst_error_db", study.worst_db}, {"worst_error_deg", study.worst_deg}};
  return numbers;
}

Picture ResponsePicture(const MidStrokeStudy& study) {
  const BodeCase& figure = study.figure();
  const std::vector<page::Rule> rules = {
      {"paper: 32 Hz", true, kPaperBandwidthHz},
      {fmt::format("-3 dB: {:.1f} Hz", figure.bandwidth_hz), true, figure.bandwidth_hz}};
  return {
      "",
      {.caption = fmt::format(
           "Swept sine of ±{} psi about zero through the closed pressure loop, arm clamped at α = 0, "
           "Table "
           "1. Fit: ω_n = {:.1f} rad/s, ζ = {:.2f}. Dashed: the linearised loop without Coulomb friction.",
           figure.sweep.amplitude, figure.fit.model.natural_frequency, figure.fit.model.damping_ratio),
       .panels = WithCoherence(
           BodePanels(
               "Closed pressure loop at mid-stroke",
               {{"measured", figure.swept.points, page::Stroke::kPoints, 0},
                {"fitted second order", Sampled(1, 100, [&](double hz) { return figure.fit.model.Gain(hz); }),
                 page::Stroke::kLine, 1},
                Predicted(figure, "linearised", page::Stroke::kDashed, 2)},
               rules, -30),
           {Measured(figure, 0)})}};
}

Picture AmplitudePicture(const MidStrokeStudy& study) {
  const BodeCase& small = study.small();
  const BodeCase& large = study.large();
  std::vector<BodeCurve> family;
  std::vector<const BodeCase*> by_amplitude;
  for (const BodeCase& one : study.cases.about_zero) by_amplitude.push_back(&one);
  std::sort(by_amplitude.begin(), by_amplitude.end(),
            [](const auto* a, const auto* b) { return a->sweep.amplitude < b->sweep.amplitude; });
  family.reserve(by_amplitude.size());
  for (const BodeCase* one : by_amplitude) {
    family.push_back(
        {fmt::format("±{} psi", one->sweep.amplitude), one->swept.points, page::Stroke::kLinePoints, -1});
  }
  return {"-amplitude",
          {.caption = fmt::format("The same at several amplitudes about zero. Small ones are limited by "
                                  "Coulomb friction (±{} psi: the pump sticks {:.0f} % of the time), large "
                                  "ones by the motor's {} in-lbf (±{} psi: saturated {:.0f} % of the time).",
                                  small.sweep.amplitude, 100 * small.swept.stuck_fraction, study.p.T_pmax,
                                  large.sweep.amplitude, 100 * large.swept.saturated_fraction),
           .panels = BodePanels("Amplitude", family, {{"paper: 32 Hz", true, kPaperBandwidthHz}}, -40)}};
}

Picture SidesPicture(const MidStrokeStudy& study) {
  const Cases& cases = study.cases;
  const BodeCase& none = cases.no_friction;
  return {
      "-sides",
      {.caption =
           fmt::format("One or both sides compressing. Points: measured, the motor never reversing or T_s = "
                       "0; curves: the linearised loop, within {:.2f} dB and {:.2f}° of all points. The "
                       "first and the third case coincide: their gains are derived for the same ω_n and ζ.",
                       study.worst_db, study.worst_deg),
       .panels = BodePanels("Compressed sides",
                            {Measured(none, 0), Measured(cases.one_sided, 1),
                             Measured(cases.one_sided_gains, 2), Predicted(none, "", page::Stroke::kLine, 0),
                             Predicted(cases.one_sided, "", page::Stroke::kLine, 1),
                             Predicted(cases.one_sided_gains, "", page::Stroke::kLine, 2)},
                            {{"paper: 32 Hz", true, kPaperBandwidthHz}}, -40)}};
}

}  // namespace

ExperimentResult RunFig6(const ExperimentOptions& options) {
  const MidStrokeStudy study = RunMidStrokeStudy(options);
  ExperimentResult result;
  result.conditions = Conditions(study);
  result.paper_says =
      "The measured frequency response is approximately second order although the system is nonlinear; the "
      "bandwidth appears to be about 200/(2π) = 32 Hz, and ω_n = 150 rad/s, ζ = .5 roughly match it at low "
      "frequencies (Figure 8).";
  result.explanation = Explanation(study);
  result.comparisons = Comparisons(study);
  result.findings = {GainsFinding(study)};
  result.numbers = JsonText(Numbers(study));
  result.table.columns = CaseColumns(study.cases.all());
  result.pictures = {ResponsePicture(study), AmplitudePicture(study), SidesPicture(study)};
  return result;
}

}  // namespace hydro::experiments
