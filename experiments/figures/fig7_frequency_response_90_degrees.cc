// Figure 7: frequency response of the closed pressure loop, arm clamped at 90 degrees, on a wider actuator.
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
#include "model/actuator.h"

namespace hydro::experiments {
namespace {

using nlohmann::json;

constexpr double kNaturalFrequency = 150;  // rad/s, Figure 8
constexpr double kDampingRatio = 0.5;      // Figure 8
constexpr double kPaperHz = 200 / (2 * std::numbers::pi);
constexpr double kQuarterTurn = std::numbers::pi / 2;
const std::vector<SweptBand> kBands = {{1, 6, 16, 4}, {6, 200, 16, 2}};

// What the model answers when it is asked for an arm angle.
std::string Refusal(const model::ModelDescription& model, double arm_angle) {
  try {
    model::Actuator actuator(model, {.shaft = model::Shaft::kClamped, .arm_angle = arm_angle});
    return "";
  } catch (const model::ModelError& error) {
    return error.what();
  }
}

struct Cases {
  BodeCase mid_stroke;    // the same gains at alpha = 0
  BodeCase quarter_turn;  // the figure
  BodeCase large;         // a larger amplitude
  BodeCase redesigned;    // gains for omega_n, zeta at pi/2
  BodeCase large_side;    // about +1000 psi: the large side 2 compresses, side 1 is held
  BodeCase small_side;    // about -1000 psi: the small side 1 compresses, side 2 is held

  std::vector<BodeCase*> all() {
    return {&quarter_turn, &mid_stroke, &large, &redesigned, &large_side, &small_side};
  }
};

Cases MakeCases(const model::ModelDescription& wide, const pressure_ctrl::PressureGains& gains,
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
  Cases cases;
  // Friction and saturation act on k_1 k_p A: about as much of both as in Figure 6.
  cases.quarter_turn = make("quarter_turn", "α = π/2", BothCompress(), 20, 0);
  cases.mid_stroke = make("mid_stroke", "α = 0", BothCompress(), 20, 0);
  cases.mid_stroke.sweep.arm_angle = 0;
  cases.large = make("large_amplitude", "α = π/2, ±100 psi", BothCompress(), 100, 0);
  cases.redesigned = make("redesigned", "α = π/2, gains for there", BothCompress(), 150, 0);
  cases.redesigned.sweep.gains = redesigned;
  // The pump must not reverse: its speed is w dp/s beside the creep (c_E + c_I) dp/D.
  cases.large_side = make("large_side", "side 2 compresses (V_2)", Side1Held(), 2, 1000);
  cases.small_side = make("small_side", "side 1 compresses (V_1)", Side2Held(), 2, -1000);
  cases.small_side.mode.pump = -1;
  return cases;
}

BodeCurve Predicted(const BodeCase& bode_case, const std::string& label, page::Stroke stroke, int colour) {
  const LinearPressureLoop loop =
      LinearLoop(bode_case.sweep, bode_case.mode, {1 / bode_case.sweep.rate_hz, 0});
  return {label, Sampled(1, 200, [&](double hz) { return loop.ClosedGain(bode_case.sweep.gains, hz); }),
          stroke, colour};
}

json Dynamics(const pressure_ctrl::SecondOrder& loop) {
  return {{"natural_frequency_rad_s", loop.natural_frequency}, {"damping_ratio", loop.damping_ratio}};
}

}  // namespace

ExperimentResult RunFig7(const ExperimentOptions& options) {
  const model::ModelDescription table1 = ShippedModel("table1");
  const model::ModelDescription wide = ShippedModel("wide_actuator");
  const model::Parameters& p = wide.parameters;
  const std::string refusal = Refusal(table1, kQuarterTurn);
  const double limit = table1.parameters.V_ms / table1.parameters.c;
  const pressure_ctrl::PressureGains gains =
      pressure_ctrl::DerivePressureGains(p, 0, kNaturalFrequency, kDampingRatio, 2);
  const pressure_ctrl::PressureGains redesigned =
      pressure_ctrl::DerivePressureGains(p, kQuarterTurn, kNaturalFrequency, kDampingRatio, 2);
  Cases cases = MakeCases(wide, gains, redesigned);
  const std::vector<BodeCase*> all = cases.all();
  for (size_t i = 0; i < all.size(); ++i) {
    Evaluate(all[i], all[i] == &cases.redesigned || all[i] == &cases.mid_stroke ? 60 : 130,
             options.run_stack);
    options.progress(static_cast<double>(i + 1) / static_cast<double>(all.size()));
  }

  const BodeCase& figure = cases.quarter_turn;
  const double V_1 = p.V_ms - p.c * kQuarterTurn;
  const double V_2 = p.V_ms + p.c * kQuarterTurn;
  const pressure_ctrl::SecondOrder two_sides = pressure_ctrl::PressureLoopDynamics(p, kQuarterTurn, gains, 2);
  const pressure_ctrl::SecondOrder large_side =
      pressure_ctrl::PressureLoopDynamics(p, kQuarterTurn, gains, 1);
  const pressure_ctrl::SecondOrder small_side =
      pressure_ctrl::PressureLoopDynamics(p, -kQuarterTurn, gains, 1);  // V_1 in V_2's place
  // omega_n^2 goes with 1/V_1 + 1/V_2 = (2/V_ms)/(1 - (c alpha/V_ms)^2).
  const double displaced = p.c * kQuarterTurn / p.V_ms;
  const double ratio = 1 / std::sqrt(1 - displaced * displaced);
  constexpr double kAlike = 1.1;  // a natural frequency within 10 % of mid-stroke's
  const double alike_V_ms = p.c * kQuarterTurn / std::sqrt(1 - 1 / (kAlike * kAlike));
  const double two_sided_hz =
      SecondOrderModel{1, two_sides.natural_frequency, two_sides.damping_ratio, 0}.BandwidthHz();
  const double worst_db = std::max(cases.large_side.worst_error_db, cases.small_side.worst_error_db);
  const double worst_deg = std::max(cases.large_side.worst_error_deg, cases.small_side.worst_error_deg);

  ExperimentResult result;
  result.conditions = fmt::format(
      "Wide actuator (V_ms = {} in^3, ASSUMED; Table 1 otherwise), clamped at α = π/2: V_1 = {:.3f}, V_2 = "
      "{:.3f} in^3. Eq. (16) without feed-forward, k_p = {:.4f} V/psi, k_v = {:.2f} psi s/rad: ω_n = {} "
      "rad/s and ζ = {} at α = 0, kept at π/2. Swept sine of ±{} psi about zero over the stack at {} Hz "
      "without command delay; Welch's cross-spectra (H1). Bandwidth: 3 dB below the gain at low frequencies.",
      p.V_ms, V_1, V_2, gains.k_p, gains.k_v, kNaturalFrequency, kDampingRatio, figure.sweep.amplitude,
      figure.sweep.rate_hz);
  result.paper_says =
      "Figure 7 repeats Figure 6 with the actuator moved by 90 degrees, α = π/2. Both appear approximately "
      "second order, with a bandwidth of about 32 Hz.";
  result.explanation = fmt::format(
      "Table 1 cannot be at π/2: its V_1 would be negative beyond {:.3f} rad. On an actuator that can, the "
      "volumes part, and the stiffness of the oil, 1/V_1 + 1/V_2, grows by 1/(1 - (c α/V_ms)²) = {:.2f}: the "
      "gains that give 150 rad/s at mid-stroke ({:.0f} measured) give {:.1f} rad/s, ζ = {:.3f} and {:.1f} Hz "
      "here. Measured at ±{} psi: {:.0f} rad/s, {:.2f} and {:.1f} Hz; at ±{} psi, with the motor saturated "
      "{:.0f} % of the time, {:.1f} Hz. Two angles with one bandwidth, as the paper has them, need gains "
      "adapted to "
      "the angle (k_p = {:.4f}, k_v = {:.1f}: {:.0f} rad/s, {:.1f} Hz) or dead volume: a natural frequency "
      "within {:.0f} % of mid-stroke's needs V_ms above {:.1f} in^3, {:.1f} times Table 1's. The direction "
      "counts, too: about +1000 psi the large side 2 compresses ({:.1f} rad/s, ζ {:.2f}), about -1000 psi "
      "the small side 1 ({:.1f} rad/s, ζ {:.2f}), with the other held at p_3.",
      limit, ratio * ratio, cases.mid_stroke.fit.model.natural_frequency, two_sides.natural_frequency,
      two_sides.damping_ratio, two_sided_hz, figure.sweep.amplitude, figure.fit.model.natural_frequency,
      figure.fit.model.damping_ratio, figure.bandwidth_hz, cases.large.sweep.amplitude,
      100 * cases.large.swept.saturated_fraction, cases.large.bandwidth_hz, redesigned.k_p, redesigned.k_v,
      cases.redesigned.fit.model.natural_frequency, cases.redesigned.bandwidth_hz, 100 * (kAlike - 1),
      alike_V_ms, alike_V_ms / table1.parameters.V_ms, cases.large_side.fit.model.natural_frequency,
      cases.large_side.fit.model.damping_ratio, cases.small_side.fit.model.natural_frequency,
      cases.small_side.fit.model.damping_ratio);

  result.comparisons = {
      {"bandwidth (-3 dB)", "Hz", "about 32", two_sided_hz, figure.bandwidth_hz,
       "expected: both sides compressing, no Coulomb friction"},
      {"natural frequency of the fit", "rad/s", "roughly 150", two_sides.natural_frequency,
       figure.fit.model.natural_frequency, "expected: 150 rad/s times the stiffness's square root"},
      {"damping ratio of the fit", "", "roughly .5", two_sides.damping_ratio, figure.fit.model.damping_ratio,
       "Coulomb friction adds to the expected"},
      {"natural frequency at α = 0, the same gains", "rad/s", "roughly 150", kNaturalFrequency,
       cases.mid_stroke.fit.model.natural_frequency, ""},
      {"bandwidth with gains for π/2", "Hz", "about 32",
       SecondOrderModel{1, kNaturalFrequency, kDampingRatio, 0}.BandwidthHz(), cases.redesigned.bandwidth_hz,
       ""},
      {"natural frequency, only V_2 compresses", "rad/s", "", large_side.natural_frequency,
       cases.large_side.fit.model.natural_frequency, ""},
      {"damping ratio, only V_2 compresses", "", "", large_side.damping_ratio,
       cases.large_side.fit.model.damping_ratio, ""},
      {"natural frequency, only V_1 compresses", "rad/s", "", small_side.natural_frequency,
       cases.small_side.fit.model.natural_frequency, ""},
      {"damping ratio, only V_1 compresses", "", "", small_side.damping_ratio,
       cases.small_side.fit.model.damping_ratio, ""},
      {"largest difference from the linearised loop, gain", "dB", "", 0, worst_db,
       "in the two cases with one side held"},
      {"largest difference from the linearised loop, phase", "degrees", "", 0, worst_deg, "the same"},
  };
  result.findings = {
      {1, "Figure 7 is at α = π/2, with Table 1's V_ms = 3.16 in^3.",
       fmt::format("Asked for it, the model of Table 1 refuses: \"{}\". V_1 = V_ms - c α is {:.2f} in^3 "
                   "there and reaches 0 at {:.4f} rad = {:.2f}°.",
                   refusal, table1.parameters.V_ms - table1.parameters.c * kQuarterTurn, limit,
                   limit * 180 / std::numbers::pi),
       fmt::format("An arm angle that leaves V_1, V_2 > 0 is an error. config/models/wide_actuator.toml has "
                   "V_ms = {} in^3 (needed: above {:.3f}), marked as an assumption; this figure uses it.",
                   p.V_ms, table1.parameters.c * kQuarterTurn)}};

  json listed = json::array();
  for (const BodeCase* one : all) listed.push_back(CaseJson(*one));
  json numbers = listed.front();
  numbers.erase("key");
  numbers.erase("title");
  numbers["model"] = wide.name;
  numbers["V_ms_in3"] = p.V_ms;
  numbers["V_1_in3"] = V_1;
  numbers["V_2_in3"] = V_2;
  numbers["paper_bandwidth_hz"] = kPaperHz;
  numbers["table1"] = {{"refusal", refusal},
                       {"V_1_in3", table1.parameters.V_ms - table1.parameters.c * kQuarterTurn},
                       {"arm_angle_limit_rad", limit}};
  numbers["expected"] = {{"both_sides", Dynamics(two_sides)},
                         {"large_side", Dynamics(large_side)},
                         {"small_side", Dynamics(small_side)},
                         {"bandwidth_hz", two_sided_hz}};
  numbers["V_ms_for_10_percent_in3"] = alike_V_ms;
  numbers["linearised"] = {{"worst_error_db", worst_db}, {"worst_error_deg", worst_deg}};
  numbers["cases"] = listed;
  result.numbers = JsonText(numbers);
  for (const BodeCase* one : all) {
    for (tables::Column& column : CaseColumns(*one)) result.table.columns.push_back(std::move(column));
  }

  const page::Rule paper = {"paper: 32 Hz", true, kPaperHz};
  result.pictures.push_back(
      {"",
       {.caption =
            fmt::format("Swept sine of ±{} psi about zero through the closed pressure loop, arm clamped at α "
                        "= π/2, actuator with V_ms = {} in^3 (assumed). Fit: ω_n = {:.0f} rad/s, ζ = {:.2f}. "
                        "Dashed: the linearised loop without Coulomb friction.",
                        figure.sweep.amplitude, p.V_ms, figure.fit.model.natural_frequency,
                        figure.fit.model.damping_ratio),
        .panels = WithCoherence(
            BodePanels(
                "Closed pressure loop at 90°",
                {{"measured, α = π/2", figure.swept.points, page::Stroke::kPoints, 0},
                 {"fitted second order",
                  Sampled(1, 200, [&](double hz) { return figure.fit.model.Gain(hz); }), page::Stroke::kLine,
                  1},
                 Predicted(figure, "linearised", page::Stroke::kDashed, 2),
                 {"measured, α = 0", cases.mid_stroke.swept.points, page::Stroke::kPoints, 3}},
                {paper, {fmt::format("-3 dB: {:.1f} Hz", figure.bandwidth_hz), true, figure.bandwidth_hz}},
                -40),
            {{"", figure.swept.points, page::Stroke::kPoints, 0},
             {"", cases.mid_stroke.swept.points, page::Stroke::kPoints, 3}}),
        .drawing = ""}});
  result.pictures.push_back(
      {"-cases",
       {.caption = "At α = π/2: a larger amplitude, gains designed for this angle, and either side alone "
                   "compressing. Curves: the linearised loop of the cases with one side held.",
        .panels =
            BodePanels("What it depends on",
                       {{cases.large.title, cases.large.swept.points, page::Stroke::kLinePoints, 0},
                        {cases.redesigned.title, cases.redesigned.swept.points, page::Stroke::kLinePoints, 1},
                        {cases.large_side.title, cases.large_side.swept.points, page::Stroke::kPoints, 2},
                        {cases.small_side.title, cases.small_side.swept.points, page::Stroke::kPoints, 3},
                        Predicted(cases.large_side, "", page::Stroke::kLine, 2),
                        Predicted(cases.small_side, "", page::Stroke::kLine, 3)},
                       {paper}, -40),
        .drawing = ""}});
  return result;
}

}  // namespace hydro::experiments
