// Figure 6: frequency response of the closed pressure loop, arm clamped at mid-stroke.
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

namespace hydro::experiments {
namespace {

using nlohmann::json;

constexpr double kNaturalFrequency = 150;  // rad/s, Figure 8
constexpr double kDampingRatio = 0.5;      // Figure 8
constexpr double kPaperHz = 200 / (2 * std::numbers::pi);
constexpr double kFitToHz = 60;
// psi, of a reference about zero. The first is the figure's own.
constexpr double kAmplitudes[] = {60, 10, 20, 30, 100, 300};

struct Cases {
  std::vector<BodeCase> about_zero;  // in the order of kAmplitudes
  BodeCase no_friction;              // T_s = 0, both sides compress
  BodeCase one_sided;                // about 1000 psi, side 1 at p_3
  BodeCase one_sided_gains;          // the same with gains designed for it
  BodeCase pumped_up;                // about 300 psi, an amplitude that lets side 1 ride above p_3

  std::vector<BodeCase*> all() {
    std::vector<BodeCase*> list;
    for (BodeCase& one : about_zero) list.push_back(&one);
    list.insert(list.end(), {&no_friction, &one_sided, &one_sided_gains, &pumped_up});
    return list;
  }
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
  free.initial_pressure = 1500;  // leaks away with (beta/V_ms) c_E = .51/s: above p_3 for the whole sweep
  free.bands = {{1, 6, 7, 4}, {6, 100, 7, 2}};
  cases.one_sided = make("one_sided", "side 1 held at p_3", Side1Held());
  cases.one_sided.linear = true;
  cases.one_sided.sweep.offset = 1000;
  cases.one_sided.sweep.amplitude = 4;
  cases.one_sided.sweep.rest_s = 3;
  cases.one_sided_gains = cases.one_sided;
  cases.one_sided_gains.key = "one_sided_own_gains";
  cases.one_sided_gains.title = "side 1 held at p_3, gains for that";
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
  const LinearPressureLoop loop =
      LinearLoop(bode_case.sweep, bode_case.mode, {1 / bode_case.sweep.rate_hz, 0});
  return {label, Sampled(1, 100, [&](double hz) { return loop.ClosedGain(bode_case.sweep.gains, hz); }),
          stroke, colour};
}

// Coulomb friction acts on a sine of the motor's speed like a viscous friction 4 T_s/(pi speed) (describing
// function). At omega_n the speed is k_1 k_p A/B with B all viscous friction, so that B, and zeta with it,
// grow by 1/(1 - 4 T_s/(pi k_1 k_p A)).
double DampingWithFriction(const model::Parameters& p, const pressure_ctrl::PressureGains& gains,
                           double damping_ratio, double amplitude) {
  return damping_ratio / (1 - 4 * p.T_s / (std::numbers::pi * p.k_1 * gains.k_p * amplitude));
}

}  // namespace

ExperimentResult RunFig6(const ExperimentOptions& options) {
  const model::ModelDescription table1 = ShippedModel("table1");
  const model::Parameters& p = table1.parameters;
  const pressure_ctrl::PressureGains two_sided =
      pressure_ctrl::DerivePressureGains(p, 0, kNaturalFrequency, kDampingRatio, 2);
  const pressure_ctrl::PressureGains one_sided =
      pressure_ctrl::DerivePressureGains(p, 0, kNaturalFrequency, kDampingRatio, 1);
  Cases cases = MakeCases(table1, two_sided, one_sided);
  const std::vector<BodeCase*> all = cases.all();
  for (size_t i = 0; i < all.size(); ++i) {
    Evaluate(all[i], kFitToHz, options.run_stack);
    options.progress(static_cast<double>(i + 1) / static_cast<double>(all.size()));
  }
  const BodeCase& figure = cases.about_zero.front();
  const BodeCase& small = cases.about_zero[1];
  const BodeCase& large = cases.about_zero.back();
  const SecondOrderModel design = {1, kNaturalFrequency, kDampingRatio, 0};
  const double sticking = p.T_s / (p.k_1 * two_sided.k_p);
  const double figure_zeta = DampingWithFriction(p, two_sided, kDampingRatio, figure.sweep.amplitude);
  const pressure_ctrl::SecondOrder one_sided_rule = pressure_ctrl::PressureLoopDynamics(p, 0, two_sided, 1);
  // Without feedback's help, at frequencies well above omega_n: J w^2 dp/s is torque, s psi per rad.
  const double stiffness = 2 * p.beta * p.D / p.V_ms;
  const double w = 2 * std::numbers::pi * kPaperHz;
  const double followed = p.T_pmax * stiffness / (p.J * w * w);
  double worst_db = 0;
  double worst_deg = 0;
  for (const BodeCase* one : all) {
    if (!one->linear) continue;
    worst_db = std::max(worst_db, one->worst_error_db);
    worst_deg = std::max(worst_deg, one->worst_error_deg);
  }

  ExperimentResult result;
  result.conditions = fmt::format(
      "Table 1, clamped at α = 0; eq. (16) without feed-forward, k_p = {:.4f} V/psi and k_v = {:.2f} psi "
      "s/rad (ω_n = {} rad/s, ζ = {}, both sides compressing). The reference is a sine of constant amplitude "
      "swept from {} to {} Hz in two runs of {} s over the stack at {} Hz without command delay. Gain and "
      "coherence by Welch's cross-spectra (H1). Bandwidth: 3 dB below the gain at low frequencies.",
      two_sided.k_p, two_sided.k_v, kNaturalFrequency, kDampingRatio, 0.25, 140, kTwoDecades[0].duration_s,
      figure.sweep.rate_hz);
  result.paper_says =
      "The measured frequency response is approximately second order although the system is nonlinear; the "
      "bandwidth appears to be about 200/(2π) = 32 Hz, and ω_n = 150 rad/s, ζ = .5 roughly match it at low "
      "frequencies (Figure 8).";
  result.explanation = fmt::format(
      "The paper prints neither amplitude nor mean of its reference. The figure here is for ±{} psi about "
      "zero, the largest of the amplitudes run at which the motor does not saturate (largest torque {:.1f} "
      "of {} in-lbf). From p_3 the valves let oil in at each swing until both sides ride above p_3, so that "
      "both compress {:.0f} % of the time and the two-sided design holds: ω_n = {:.0f} rad/s, ζ = {:.2f}, "
      "{:.1f} Hz. The design itself has {:.1f} Hz; what is missing is Coulomb friction, which damps a sine "
      "of amplitude A by the factor 1/(1 - (4/π) T_s/(k_1 k_p A)): ζ = {:.2f}. At ±{} psi it dominates (gain "
      "{:.2f} at low frequency; below {:.1f} psi = T_s/(k_1 k_p) nothing moves); without it ω_n = {:.1f} and "
      "ζ = {:.3f} come out. At ±{} psi the motor saturates {:.0f} % of the time and {:.1f} Hz are left: 40 "
      "in-lbf accelerate the pump for {:.0f} psi at 32 Hz and no more. ±30, ±60 and ±100 psi have {:.1f}, "
      "{:.1f} and {:.1f} Hz: amplitudes of this order fit the paper's figure. About {} psi, with ±{} psi, "
      "the pump creeps forward to make up for leakage and never reverses, side 1 stays at p_3 and the same "
      "gains give {:.1f} rad/s, {:.3f} and {:.1f} Hz; gains for one side ({:.3f}, {:.2f}) bring {:.1f} rad/s "
      "and {:.1f} Hz back.",
      figure.sweep.amplitude, figure.swept.largest_torque, p.T_pmax,
      100 * figure.swept.both_compress_fraction, figure.fit.model.natural_frequency,
      figure.fit.model.damping_ratio, figure.bandwidth_hz, design.BandwidthHz(), figure_zeta,
      small.sweep.amplitude, small.low_gain, sticking, cases.no_friction.fit.model.natural_frequency,
      cases.no_friction.fit.model.damping_ratio, large.sweep.amplitude, 100 * large.swept.saturated_fraction,
      large.bandwidth_hz, followed, cases.about_zero[3].bandwidth_hz, figure.bandwidth_hz,
      cases.about_zero[4].bandwidth_hz, cases.one_sided.sweep.offset, cases.one_sided.sweep.amplitude,
      cases.one_sided.fit.model.natural_frequency, cases.one_sided.fit.model.damping_ratio,
      cases.one_sided.bandwidth_hz, one_sided.k_p, one_sided.k_v,
      cases.one_sided_gains.fit.model.natural_frequency, cases.one_sided_gains.bandwidth_hz);

  const auto& none = cases.no_friction;
  result.comparisons = {
      {"bandwidth (-3 dB)", "Hz", "about 32", design.BandwidthHz(), figure.bandwidth_hz,
       "expected: closed form for ω_n = 150, ζ = .5"},
      {"natural frequency of the fit", "rad/s", "roughly 150", kNaturalFrequency,
       figure.fit.model.natural_frequency, ""},
      {"damping ratio of the fit", "", "roughly .5", figure_zeta, figure.fit.model.damping_ratio,
       "expected: .5 and Coulomb friction's describing function"},
      {"natural frequency, T_s = 0, both sides compress", "rad/s", "", kNaturalFrequency,
       none.fit.model.natural_frequency, ""},
      {"damping ratio, T_s = 0, both sides compress", "", "", kDampingRatio, none.fit.model.damping_ratio,
       "holding the voltage for 0.2 ms takes the difference"},
      {"bandwidth, T_s = 0, both sides compress", "Hz", "", design.BandwidthHz(), none.bandwidth_hz, ""},
      {"natural frequency, side 1 held at p_3", "rad/s", "", one_sided_rule.natural_frequency,
       cases.one_sided.fit.model.natural_frequency, "expected: 150/√2"},
      {"damping ratio, side 1 held at p_3", "", "", one_sided_rule.damping_ratio,
       cases.one_sided.fit.model.damping_ratio, "expected: .5 √2"},
      {"bandwidth, side 1 held at p_3", "Hz", "",
       SecondOrderModel{1, one_sided_rule.natural_frequency, one_sided_rule.damping_ratio, 0}.BandwidthHz(),
       cases.one_sided.bandwidth_hz, ""},
      {"natural frequency, side 1 held at p_3, gains for that", "rad/s", "", kNaturalFrequency,
       cases.one_sided_gains.fit.model.natural_frequency, ""},
      {"bandwidth at ±300 psi", "Hz", "", page::kAutomatic, large.bandwidth_hz, "the motor's torque limit"},
      {"largest difference from the linearised loop, gain", "dB", "", 0, worst_db,
       "in the cases without friction's switching"},
      {"largest difference from the linearised loop, phase", "degrees", "", 0, worst_deg, "the same"},
  };
  result.findings = {
      {4, "The gains k_p and k_v of eq. (16) are not printed; they were chosen experimentally.",
       fmt::format("ω_n = 150 rad/s and ζ = .5 of Figure 8 give k_p = {:.4f} V/psi, k_v = {:.2f} psi s/rad "
                   "when both sides compress and {:.3f}, {:.2f} when one side is held at p_3. With the first "
                   "pair the swept sine measures {:.1f} rad/s, {:.3f} with both sides compressing (T_s = 0) "
                   "and {:.1f} rad/s, {:.3f} with one; with the second pair one side gives {:.1f} rad/s, "
                   "{:.3f}. Viscous friction b is {:.1f} % of the damping.",
                   two_sided.k_p, two_sided.k_v, one_sided.k_p, one_sided.k_v,
                   none.fit.model.natural_frequency, none.fit.model.damping_ratio,
                   cases.one_sided.fit.model.natural_frequency, cases.one_sided.fit.model.damping_ratio,
                   cases.one_sided_gains.fit.model.natural_frequency,
                   cases.one_sided_gains.fit.model.damping_ratio,
                   100 * p.b / (p.b + p.k_1 * two_sided.k_p * two_sided.k_v)),
       "Gains are derived from ω_n, ζ and the number of compressed sides (pressure.compressed_sides), by "
       "default two; both modes are shown."}};

  json listed = json::array();
  for (const BodeCase* one : all) listed.push_back(CaseJson(*one));
  json numbers = listed.front();
  numbers.erase("key");
  numbers.erase("title");
  numbers["paper_bandwidth_hz"] = kPaperHz;
  numbers["design_bandwidth_hz"] = design.BandwidthHz();
  numbers["damping_ratio_with_friction_expected"] = figure_zeta;
  numbers["sticks_below_psi"] = sticking;
  numbers["amplitude_that_torque_allows_at_32_hz_psi"] = followed;
  numbers["gains"] = {
      {"two_sided", {{"k_p_V_per_psi", two_sided.k_p}, {"k_v_psi_s_per_rad", two_sided.k_v}}},
      {"one_sided", {{"k_p_V_per_psi", one_sided.k_p}, {"k_v_psi_s_per_rad", one_sided.k_v}}}};
  numbers["linearised"] = {{"worst_error_db", worst_db}, {"worst_error_deg", worst_deg}};
  numbers["cases"] = listed;
  result.numbers = JsonText(numbers);
  for (const BodeCase* one : all) {
    for (tables::Column& column : CaseColumns(*one)) result.table.columns.push_back(std::move(column));
  }

  const std::vector<page::Rule> rules = {
      {"paper: 32 Hz", true, kPaperHz},
      {fmt::format("-3 dB: {:.1f} Hz", figure.bandwidth_hz), true, figure.bandwidth_hz}};
  result.pictures.push_back(
      {"",
       {.caption = fmt::format(
            "Swept sine of ±{} psi about zero through the closed pressure loop, arm clamped at α = 0, Table "
            "1. Fit: ω_n = {:.1f} rad/s, ζ = {:.2f}. Dashed: the linearised loop without Coulomb friction.",
            figure.sweep.amplitude, figure.fit.model.natural_frequency, figure.fit.model.damping_ratio),
        .panels =
            WithCoherence(BodePanels("Closed pressure loop at mid-stroke",
                                     {{"measured", figure.swept.points, page::Stroke::kPoints, 0},
                                      {"fitted second order",
                                       Sampled(1, 100, [&](double hz) { return figure.fit.model.Gain(hz); }),
                                       page::Stroke::kLine, 1},
                                      Predicted(figure, "linearised", page::Stroke::kDashed, 2)},
                                     rules, -30),
                          {Measured(figure, 0)}),
        .drawing = ""}});
  std::vector<BodeCurve> family;
  std::vector<const BodeCase*> by_amplitude;
  for (const BodeCase& one : cases.about_zero) by_amplitude.push_back(&one);
  std::sort(by_amplitude.begin(), by_amplitude.end(),
            [](const auto* a, const auto* b) { return a->sweep.amplitude < b->sweep.amplitude; });
  family.reserve(by_amplitude.size());
  for (const BodeCase* one : by_amplitude) {
    family.push_back(
        {fmt::format("±{} psi", one->sweep.amplitude), one->swept.points, page::Stroke::kLinePoints, -1});
  }
  result.pictures.push_back(
      {"-amplitude",
       {.caption = fmt::format("The same at several amplitudes about zero. Small ones are held by Coulomb "
                               "friction (±{} psi: the pump sticks {:.0f} % of the time), large ones by the "
                               "motor's {} in-lbf (±{} psi: saturated {:.0f} % of the time).",
                               small.sweep.amplitude, 100 * small.swept.stuck_fraction, p.T_pmax,
                               large.sweep.amplitude, 100 * large.swept.saturated_fraction),
        .panels = BodePanels("Amplitude", family, {{"paper: 32 Hz", true, kPaperHz}}, -40),
        .drawing = ""}});
  result.pictures.push_back(
      {"-sides",
       {.caption =
            fmt::format("One or both sides compressing. Points: measured, the motor never reversing or T_s = "
                        "0; curves: the linearised loop, within {:.2f} dB and {:.2f}° of all points. The "
                        "first and the third case coincide: their gains are derived for the same ω_n and ζ.",
                        worst_db, worst_deg),
        .panels = BodePanels("Compressed sides",
                             {Measured(none, 0), Measured(cases.one_sided, 1),
                              Measured(cases.one_sided_gains, 2), Predicted(none, "", page::Stroke::kLine, 0),
                              Predicted(cases.one_sided, "", page::Stroke::kLine, 1),
                              Predicted(cases.one_sided_gains, "", page::Stroke::kLine, 2)},
                             {{"paper: 32 Hz", true, kPaperHz}}, -40),
        .drawing = ""}});
  return result;
}

}  // namespace hydro::experiments
