// Figure 7: frequency response of the closed pressure loop, arm clamped at 90 degrees, on a wider actuator.
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "base/units.h"
#include "experiments/figures/catalogue.h"
#include "experiments/runs/pressure_loop_run.h"
#include "experiments/runs/shipped_models.h"
#include "experiments/studies/bode_case.h"
#include "experiments/studies/experiment.h"
#include "model/actuator.h"

namespace hydro::experiments {
namespace {

using nlohmann::json;

constexpr double kFigure7ShownToHz = 200;
constexpr double kQuarterTurn = std::numbers::pi / 2;
const std::vector<SweptBand> kBands = {{1, 6, 16, 4}, {6, 200, 16, 2}};

constexpr double kAlike = 1.1;  // alike: natural frequency within 10 % of mid-stroke's

// The model's error message for an arm angle.
std::string Refusal(const model::ModelDescription& model, double arm_angle) {
  try {
    model::Actuator actuator(model, {.shaft = model::Shaft::kClamped, .arm_angle = arm_angle});
    return "";
  } catch (const model::ModelError& error) {
    return error.what();
  }
}

struct QuarterTurnCases {
  BodeCase mid_stroke;    // the same gains at alpha = 0
  BodeCase quarter_turn;  // the figure
  BodeCase large;         // a larger amplitude
  BodeCase redesigned;    // gains for omega_n, zeta at pi/2
  BodeCase large_side;    // about +1000 psi: the large side 2 compresses, side 1 is held
  BodeCase small_side;    // about -1000 psi: the small side 1 compresses, side 2 is held

  std::vector<BodeCase*> all() {
    return {&quarter_turn, &mid_stroke, &large, &redesigned, &large_side, &small_side};
  }
  std::vector<const BodeCase*> all() const {
    return {&quarter_turn, &mid_stroke, &large, &redesigned, &large_side, &small_side};
  }
};

QuarterTurnCases MakeQuarterTurnCases(const model::ModelDescription& wide,
                                      const pressure_ctrl::PressureGains& gains,
                                      const pressure_ctrl::PressureGains& redesigned) {
  const auto make = [&](const std::string& key, const std::string& title, const model::Mode& mode,
                        double amplitude, double offset) {
    BodeCase made;
    made.key = key;
    made.title = title;
    made.mode = mode;
    made.linear = offset != 0;
    made.sweep.name = "fig7-" + key;
    made.sweep.model = wide;
    made.sweep.arm_angle = kQuarterTurn;
    made.sweep.gains = gains;
    made.sweep.amplitude = amplitude;
    made.sweep.offset = offset;
    made.sweep.rest_s = offset != 0 ? 3 : 1;
    made.sweep.bands = kBands;
    return made;
  };
  QuarterTurnCases cases;
  // Friction and saturation depend on k_1 k_p A: about as much of both as in Figure 6.
  cases.quarter_turn = make("quarter_turn", "α = π/2", BothCompress(), 20, 0);
  cases.mid_stroke = make("mid_stroke", "α = 0", BothCompress(), 20, 0);
  cases.mid_stroke.sweep.arm_angle = 0;
  cases.large = make("large_amplitude", "α = π/2, ±100 psi", BothCompress(), 100, 0);
  cases.redesigned = make("redesigned", "α = π/2, gains designed for it", BothCompress(), 150, 0);
  cases.redesigned.sweep.gains = redesigned;
  // The pump must not reverse: its speed is w dp/s on top of the creep (c_E + c_I) dp/D.
  cases.large_side = make("large_side", "side 2 compresses (V_2)", Side1Held(), 2, 1000);
  cases.small_side = make("small_side", "side 1 compresses (V_1)", Side2Held(), 2, -1000);
  cases.small_side.mode.pump = -1;
  return cases;
}

BodeCurve PredictedAtQuarterTurn(const BodeCase& bode_case, const std::string& label, page::Stroke stroke,
                                 int colour) {
  return PredictedCurve(bode_case, label, kFigure7ShownToHz, stroke, colour);
}

json Dynamics(const pressure_ctrl::SecondOrder& loop) {
  return {{"natural_frequency_rad_s", loop.natural_frequency}, {"damping_ratio", loop.damping_ratio}};
}

struct QuarterTurnStudy {
  model::Parameters table1;
  model::ModelDescription wide;
  std::string refusal;  // Table 1's, for a quarter turn
  pressure_ctrl::PressureGains gains, redesigned;
  QuarterTurnCases cases;

  // The results in closed form.
  double limit = 0;         // rad, where Table 1's V_1 is 0
  double V_1 = 0, V_2 = 0;  // in^3, the wide actuator's
  pressure_ctrl::SecondOrder two_sides, large_side, small_side;
  double ratio = 0;         // natural frequency over mid-stroke's
  double alike_V_ms = 0;    // in^3, makes the ratio kAlike
  double two_sided_hz = 0;  // bandwidth

  const BodeCase& figure() const { return cases.quarter_turn; }
  double worst_db() const {
    return std::max(cases.large_side.worst_error_db, cases.small_side.worst_error_db);
  }
  double worst_deg() const {
    return std::max(cases.large_side.worst_error_deg, cases.small_side.worst_error_deg);
  }
};

void SolveInClosedForm(QuarterTurnStudy* study) {
  const model::Parameters& p = study->wide.parameters;
  const pressure_ctrl::PressureGains& gains = study->gains;
  study->limit = study->table1.V_ms / study->table1.c;
  study->V_1 = p.V_ms - p.c * kQuarterTurn;
  study->V_2 = p.V_ms + p.c * kQuarterTurn;
  study->two_sides = pressure_ctrl::PressureLoopDynamics(p, kQuarterTurn, gains, 2);
  study->large_side = pressure_ctrl::PressureLoopDynamics(p, kQuarterTurn, gains, 1);
  // The small side: V_1 replaces V_2.
  study->small_side = pressure_ctrl::PressureLoopDynamics(p, -kQuarterTurn, gains, 1);
  // omega_n^2 is proportional to 1/V_1 + 1/V_2 = (2/V_ms)/(1 - (c alpha/V_ms)^2).
  const double displaced = p.c * kQuarterTurn / p.V_ms;
  study->ratio = 1 / std::sqrt(1 - displaced * displaced);
  study->alike_V_ms = p.c * kQuarterTurn / std::sqrt(1 - 1 / (kAlike * kAlike));
  study->two_sided_hz =
      design::SecondOrderModel{1, study->two_sides.natural_frequency, study->two_sides.damping_ratio, 0}
          .BandwidthHz();
}

QuarterTurnStudy RunQuarterTurnStudy(const ExperimentOptions& options) {
  const model::ModelDescription table1 = ShippedModel("table1");
  QuarterTurnStudy study;
  study.table1 = table1.parameters;
  study.wide = ShippedModel("wide_actuator");
  study.refusal = Refusal(table1, kQuarterTurn);
  const model::Parameters& p = study.wide.parameters;
  study.gains = pressure_ctrl::DerivePressureGains(p, 0, kLoopNaturalFrequency, kLoopDampingRatio, 2);
  study.redesigned =
      pressure_ctrl::DerivePressureGains(p, kQuarterTurn, kLoopNaturalFrequency, kLoopDampingRatio, 2);
  study.cases = MakeQuarterTurnCases(study.wide, study.gains, study.redesigned);
  const std::vector<BodeCase*> all = study.cases.all();
  for (size_t i = 0; i < all.size(); ++i) {
    const bool slow = all[i] == &study.cases.redesigned || all[i] == &study.cases.mid_stroke;
    Evaluate(all[i], slow ? 60 : 130, options.run_stack);
    options.progress(static_cast<double>(i + 1) / static_cast<double>(all.size()));
  }
  SolveInClosedForm(&study);
  return study;
}

std::string Conditions(const QuarterTurnStudy& study) {
  const model::Parameters& p = study.wide.parameters;
  return fmt::format(
      "Wide actuator (V_ms = {} in^3, ASSUMED; Table 1 otherwise), clamped at α = π/2: V_1 = {:.3f}, V_2 = "
      "{:.3f} in^3. Eq. (16) without feed-forward, k_p = {:.4f} V/psi, k_v = {:.2f} psi s/rad: ω_n = {} "
      "rad/s and ζ = {} at α = 0, kept at π/2. Swept sine of ±{} psi about zero over the stack at {} Hz "
      "without command delay; Welch's cross-spectra (H1). Bandwidth: 3 dB below the gain at low frequencies.",
      p.V_ms, study.V_1, study.V_2, study.gains.k_p, study.gains.k_v, kLoopNaturalFrequency,
      kLoopDampingRatio, study.figure().sweep.amplitude, study.figure().sweep.rate_hz);
}

std::string Explanation(const QuarterTurnStudy& study) {
  const QuarterTurnCases& cases = study.cases;
  const BodeCase& figure = study.figure();
  return fmt::format(
      "Table 1's actuator cannot be at π/2: its V_1 would be negative beyond {limit:.3f} rad. On one that "
      "can, the two volumes differ, and the stiffness of the oil, 1/V_1 + 1/V_2, grows by 1/(1 - (c "
      "α/V_ms)²) = {stiffness:.2f}: the gains that give 150 rad/s at mid-stroke ({mid_stroke_omega:.0f} "
      "measured) give {omega:.1f} rad/s, ζ = {zeta:.3f} and {bandwidth:.1f} Hz here. Measured at "
      "±{amplitude} psi: {measured_omega:.0f} rad/s, {measured_zeta:.2f} and {measured_bandwidth:.1f} Hz; at "
      "±{large_amplitude} psi, with the motor saturated {saturated_percent:.0f} % of the time, "
      "{large_bandwidth:.1f} Hz. For one bandwidth at both angles, as in the paper, the gains must be "
      "adapted to the angle (k_p = {k_p:.4f}, k_v = {k_v:.1f}: {redesigned_omega:.0f} rad/s, "
      "{redesigned_bandwidth:.1f} Hz), or the dead volume must be larger: a natural frequency within "
      "{alike_percent:.0f} % of mid-stroke's needs V_ms above {alike_V_ms:.1f} in^3, {alike_ratio:.1f} times "
      "Table 1's. The direction matters too: about +1000 psi the large side 2 compresses "
      "({large_side_omega:.1f} rad/s, ζ {large_side_zeta:.2f}), about -1000 psi the small side 1 "
      "({small_side_omega:.1f} rad/s, ζ {small_side_zeta:.2f}), with the other held at p_3.",
      fmt::arg("limit", study.limit), fmt::arg("stiffness", study.ratio * study.ratio),
      fmt::arg("mid_stroke_omega", cases.mid_stroke.fit.model.natural_frequency),
      fmt::arg("omega", study.two_sides.natural_frequency), fmt::arg("zeta", study.two_sides.damping_ratio),
      fmt::arg("bandwidth", study.two_sided_hz), fmt::arg("amplitude", figure.sweep.amplitude),
      fmt::arg("measured_omega", figure.fit.model.natural_frequency),
      fmt::arg("measured_zeta", figure.fit.model.damping_ratio),
      fmt::arg("measured_bandwidth", figure.bandwidth_hz),
      fmt::arg("large_amplitude", cases.large.sweep.amplitude),
      fmt::arg("saturated_percent", 100 * cases.large.swept.saturated_fraction),
      fmt::arg("large_bandwidth", cases.large.bandwidth_hz), fmt::arg("k_p", study.redesigned.k_p),
      fmt::arg("k_v", study.redesigned.k_v),
      fmt::arg("redesigned_omega", cases.redesigned.fit.model.natural_frequency),
      fmt::arg("redesigned_bandwidth", cases.redesigned.bandwidth_hz),
      fmt::arg("alike_percent", 100 * (kAlike - 1)), fmt::arg("alike_V_ms", study.alike_V_ms),
      fmt::arg("alike_ratio", study.alike_V_ms / study.table1.V_ms),
      fmt::arg("large_side_omega", cases.large_side.fit.model.natural_frequency),
      fmt::arg("large_side_zeta", cases.large_side.fit.model.damping_ratio),
      fmt::arg("small_side_omega", cases.small_side.fit.model.natural_frequency),
      fmt::arg("small_side_zeta", cases.small_side.fit.model.damping_ratio));
}

std::vector<Comparison> Comparisons(const QuarterTurnStudy& study) {
  const QuarterTurnCases& cases = study.cases;
  const BodeCase& figure = study.figure();
  return {{"bandwidth (-3 dB)", "Hz", "about 32", study.two_sided_hz, figure.bandwidth_hz,
           "expected: both sides compressing, no Coulomb friction"},
          {"natural frequency of the fit", "rad/s", "roughly 150", study.two_sides.natural_frequency,
           figure.fit.model.natural_frequency, "expected: 150 rad/s times the stiffness's square root"},
          {"damping ratio of the fit", "", "roughly .5", study.two_sides.damping_ratio,
           figure.fit.model.damping_ratio, "Coulomb friction adds to the expected value"},
          {"natural frequency at α = 0, the same gains", "rad/s", "roughly 150", kLoopNaturalFrequency,
           cases.mid_stroke.fit.model.natural_frequency, ""},
          {"bandwidth with gains for π/2", "Hz", "about 32",
           design::SecondOrderModel{1, kLoopNaturalFrequency, kLoopDampingRatio, 0}.BandwidthHz(),
           cases.redesigned.bandwidth_hz, ""},
          {"natural frequency, only V_2 compresses", "rad/s", "", study.large_side.natural_frequency,
           cases.large_side.fit.model.natural_frequency, ""},
          {"damping ratio, only V_2 compresses", "", "", study.large_side.damping_ratio,
           cases.large_side.fit.model.damping_ratio, ""},
          {"natural frequency, only V_1 compresses", "rad/s", "", study.small_side.natural_frequency,
           cases.small_side.fit.model.natural_frequency, ""},
          {"damping ratio, only V_1 compresses", "", "", study.small_side.damping_ratio,
           cases.small_side.fit.model.damping_ratio, ""},
          {"largest difference from the linearised loop, gain", "dB", "", 0, study.worst_db(),
           "in the two cases with one side held"},
          {"largest difference from the linearised loop, phase", "degrees", "", 0, study.worst_deg(),
           "the same"}};
}

Finding AngleFinding(const QuarterTurnStudy& study) {
  const model::Parameters& table1 = study.table1;
  return {
      1, "Figure 7 is at α = π/2, with Table 1's V_ms = 3.16 in^3.",
      fmt::format("Asked for that angle, the model of Table 1 refuses: \"{}\". V_1 = V_ms - c α is {:.2f} "
                  "in^3 there and reaches 0 at {:.4f} rad = {:.2f}°.",
                  study.refusal, table1.V_ms - table1.c * kQuarterTurn, study.limit, Degrees(study.limit)),
      fmt::format("An arm angle that leaves V_1, V_2 > 0 is an error. config/models/wide_actuator.toml has "
                  "V_ms = {} in^3 (needed: above {:.3f}), marked as an assumption; this figure uses it.",
                  study.wide.parameters.V_ms, table1.c * kQuarterTurn)};
}

json Numbers(const QuarterTurnStudy& study) {
  const model::Parameters& table1 = study.table1;
  json numbers = CasesJson(study.cases.all());
  numbers["model"] = study.wide.name;
  numbers["V_ms_in3"] = study.wide.parameters.V_ms;
  numbers["V_1_in3"] = study.V_1;
  numbers["V_2_in3"] = study.V_2;
  numbers["paper_bandwidth_hz"] = kPaperBandwidthHz;
  numbers["table1"] = {{"refusal", study.refusal},
                       {"V_1_in3", table1.V_ms - table1.c * kQuarterTurn},
                       {"arm_angle_limit_rad", study.limit}};
  numbers["expected"] = {{"both_sides", Dynamics(study.two_sides)},
                         {"large_side", Dynamics(study.large_side)},
                         {"small_side", Dynamics(study.small_side)},
                         {"bandwidth_hz", study.two_sided_hz}};
  numbers["V_ms_for_10_percent_in3"] = study.alike_V_ms;
  numbers["linearised"] = {{"worst_error_db", study.worst_db()}, {"worst_error_deg", study.worst_deg()}};
  return numbers;
}

page::Rule PaperRule() { return {"paper: 32 Hz", true, kPaperBandwidthHz}; }

Picture ResponsePicture(const QuarterTurnStudy& study) {
  const BodeCase& figure = study.figure();
  const QuarterTurnCases& cases = study.cases;
  return {"",
          {.caption = fmt::format(
               "Swept sine of ±{} psi about zero through the closed pressure loop, arm clamped at α "
               "= π/2, actuator with V_ms = {} in^3 (assumed). Fit: ω_n = {:.0f} rad/s, ζ = {:.2f}. "
               "Dashed: the linearised loop without Coulomb friction.",
               figure.sweep.amplitude, study.wide.parameters.V_ms, figure.fit.model.natural_frequency,
               figure.fit.model.damping_ratio),
           .panels = WithCoherence(
               BodePanels("Closed pressure loop at 90°",
                          {{"measured, α = π/2", figure.swept.points, page::Stroke::kPoints, 0},
                           {"fitted second order",
                            Sampled(1, 200, [&](double hz) { return figure.fit.model.Gain(hz); }),
                            page::Stroke::kLine, 1},
                           PredictedAtQuarterTurn(figure, "linearised", page::Stroke::kDashed, 2),
                           {"measured, α = 0", cases.mid_stroke.swept.points, page::Stroke::kPoints, 3}},
                          {PaperRule(),
                           {fmt::format("-3 dB: {:.1f} Hz", figure.bandwidth_hz), true, figure.bandwidth_hz}},
                          -40),
               {{"", figure.swept.points, page::Stroke::kPoints, 0},
                {"", cases.mid_stroke.swept.points, page::Stroke::kPoints, 3}})}};
}

Picture CasesPicture(const QuarterTurnCases& cases) {
  return {"-cases",
          {.caption = "At α = π/2: a larger amplitude, gains designed for this angle, and either side alone "
                      "compressing. Curves: the linearised loop for the cases with one side held.",
           .panels = BodePanels(
               "Influence of amplitude, gains and direction",
               {{cases.large.title, cases.large.swept.points, page::Stroke::kLinePoints, 0},
                {cases.redesigned.title, cases.redesigned.swept.points, page::Stroke::kLinePoints, 1},
                {cases.large_side.title, cases.large_side.swept.points, page::Stroke::kPoints, 2},
                {cases.small_side.title, cases.small_side.swept.points, page::Stroke::kPoints, 3},
                PredictedAtQuarterTurn(cases.large_side, "", page::Stroke::kLine, 2),
                PredictedAtQuarterTurn(cases.small_side, "", page::Stroke::kLine, 3)},
               {PaperRule()}, -40)}};
}

}  // namespace

ExperimentResult RunFig7(const ExperimentOptions& options) {
  const QuarterTurnStudy study = RunQuarterTurnStudy(options);
  ExperimentResult result;
  result.conditions = Conditions(study);
  result.paper_says =
      "Figure 7 repeats Figure 6 with the actuator moved by 90 degrees, α = π/2. Both appear approximately "
      "second order, with a bandwidth of about 32 Hz.";
  result.explanation = Explanation(study);
  result.comparisons = Comparisons(study);
  result.findings = {AngleFinding(study)};
  result.numbers = JsonText(Numbers(study));
  result.table.columns = CaseColumns(study.cases.all());
  result.pictures = {ResponsePicture(study), CasesPicture(study.cases)};
  return result;
}

}  // namespace hydro::experiments
