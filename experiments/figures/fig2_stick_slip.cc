// Figure 2: the clamped actuator under a low torque, with Table 1 alone and with static friction above
// kinetic friction.
#include <spdlog/fmt/fmt.h>

#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "experiments/figures/catalogue.h"
#include "experiments/runs/open_loop_run.h"
#include "experiments/runs/shipped_models.h"
#include "experiments/studies/experiment.h"

namespace hydro::experiments {
namespace {

using nlohmann::json;

constexpr double kStickSlipTorque = 6;     // in-lbf: "low"
constexpr double kStickSlipDuration = 20;  // s; cycles are judged in its second half
constexpr double kPictured = 8;            // s
constexpr double kFasterTorque = 10;       // in-lbf, Figure 3's, which does not stick and slip
// Static friction that acts only at rest: its excess vanishes at speeds at which the pump has hardly moved.
constexpr double kAtRestOnly = 1e-4;  // rad/s

model::ModelDescription WithStaticAtRest(double static_torque) {
  model::ModelDescription model = ShippedModel("table1");
  model.effects.push_back(
      {"pump.stribeck",
       {{"static_excess", static_torque / model.parameters.T_s - 1}, {"speed", kAtRestOnly}},
       {}});
  return model;
}

struct Scanned {
  double torque = 0;
  double static_torque = 0;
  size_t sticks = 0;
  StickSlipCycles cycles;

  // (T_static - T_s)/(T_p - T_s): with dp in units of (T_p - T_s)/D, the equations are the same for all
  // torques.
  double ExcessRatio(double kinetic) const { return (static_torque - kinetic) / (torque - kinetic); }
};

Scanned Scan(const model::ModelDescription& model, double torque, double static_torque, double duration) {
  const OpenLoopRun run = RunOpenLoop(model, torque, duration);
  return {torque, static_torque, run.sticks(), FindCycles(run)};
}

// The least static friction (in-lbf) with sustained cycles at kStickSlipTorque, bracketed.
struct Threshold {
  double none = 0;    // in-lbf, without cycles
  double cycles = 0;  // in-lbf, with cycles
};
Threshold FindThreshold() {
  Threshold threshold{4.0, 4.4};
  for (int i = 0; i < 7; ++i) {
    const double middle = (threshold.none + threshold.cycles) / 2;
    const bool sustained =
        FindCycles(RunOpenLoop(WithStaticAtRest(middle), kStickSlipTorque, kStickSlipDuration)).sustained;
    (sustained ? threshold.cycles : threshold.none) = middle;
  }
  return threshold;
}

json Describe(const Scanned& scanned, double kinetic) {
  json out = {{"torque_in_lbf", scanned.torque},
              {"static_torque_in_lbf", scanned.static_torque},
              {"excess_ratio", scanned.ExcessRatio(kinetic)},
              {"sticks", scanned.sticks},
              {"sustained", scanned.cycles.sustained}};
  if (scanned.cycles.sustained) {
    out["period_s"] = scanned.cycles.period;
    out["high_psi"] = scanned.cycles.high;
    out["low_psi"] = scanned.cycles.low;
    out["swing_psi"] = scanned.cycles.high - scanned.cycles.low;
    out["stick_dp_psi"] = scanned.cycles.stick_dp;
    out["slip_dp_psi"] = scanned.cycles.slip_dp;
  }
  return out;
}

// The part of a run that the picture shows.
page::Curve DpCurve(const OpenLoopRun& run, const std::string& label, int colour) {
  page::Curve curve{.label = label, .colour = colour};
  for (size_t i = 0; i < run.time.size() && run.time[i] <= kPictured; ++i) {
    curve.x.push_back(run.time[i]);
    curve.y.push_back(run.dp[i]);
  }
  return curve;
}

std::vector<page::Note> ChangeNotes(const OpenLoopRun& run, size_t most) {
  std::vector<page::Note> notes;
  for (const PumpChange& change : run.changes) {
    if (notes.size() == most || change.time > kPictured) break;
    notes.push_back({fmt::format("{} at {:.3f} s, {:.0f} psi", change.sticks ? "sticks" : "slips",
                                 change.time, change.dp),
                     change.time, change.dp});
  }
  return notes;
}

page::Panel DpPanel(const std::string& title, std::vector<page::Curve> curves,
                    std::vector<page::Note> notes) {
  return {.title = title,
          .x = {.label = "time, s", .min = 0, .max = kPictured},
          .y = {.label = "p_2 - p_1, psi", .min = 0},
          .curves = std::move(curves),
          .notes = std::move(notes)};
}

struct StickSlipStudy {
  model::Parameters p;
  // The shipped assumption: static friction above kinetic.
  double excess = 0;
  double speed = 0;  // rad/s, scale on which the excess falls off
  double static_torque = 0;

  OpenLoopRun plain;    // Table 1 alone
  OpenLoopRun cycling;  // with the shipped assumption
  StickSlipCycles cycles;
  std::vector<Scanned> plain_scan;  // Table 1 alone at other torques
  std::vector<page::Curve> scaled;  // some of them
  std::vector<Scanned> stribeck_scan;

  // How much static friction cycles need, and its effect.
  Threshold threshold;
  double threshold_ratio = 0;
  std::vector<Scanned> at_rest;

  // The results in closed form.
  double creep_dp = 0;        // psi
  double leak_rate = 0;       // 1/s
  double slip_dp = 0;         // psi
  double largest_static = 0;  // in-lbf, the largest without cycles at kFasterTorque

  const PumpChange& stick() const { return plain.changes.at(0); }
  const PumpChange& slip() const { return plain.changes.at(1); }
};

void ScanTable1(const model::ModelDescription& table1, StickSlipStudy* study) {
  for (const double torque : {4.1, 4.5, 5.0, 6.0, 8.0, 10.0}) {
    const OpenLoopRun run = RunOpenLoop(table1, torque, kStickSlipDuration / 2);
    study->plain_scan.push_back({torque, study->p.T_s, run.sticks(), FindCycles(run)});
    if (torque == 4.5 || torque == 6 || torque == 8 || torque == 10) {
      study->scaled.push_back(DpCurve(run, fmt::format("T_p = {} in-lbf", torque), -1));
    }
  }
}

void ScanStaticFriction(const model::ModelDescription& stribeck, StickSlipStudy* study) {
  for (const double at : {4.2, 4.22, 4.4, 4.8, 5.2, 5.6}) {
    study->at_rest.push_back(Scan(WithStaticAtRest(at), kStickSlipTorque, at,
                                  at > 5 ? 2 * kStickSlipDuration : kStickSlipDuration));
  }
  for (const double at : {4.4, 4.8}) {
    study->at_rest.push_back(Scan(WithStaticAtRest(at), kFasterTorque, at, kStickSlipDuration));
  }
  for (const double torque : {5.0, 8.0, 10.0}) {
    study->stribeck_scan.push_back(Scan(stribeck, torque, study->static_torque, kStickSlipDuration));
  }
}

void SolveInClosedForm(StickSlipStudy* study) {
  const model::Parameters& p = study->p;
  // The end state of Table 1 alone: slipping steadily, side 1 held at p_3 by its valve, q_2 = 0 in eq. (12),
  // eq. (4).
  const double creep_per_psi = (p.c_E + p.c_I) / p.D;
  study->creep_dp = (kStickSlipTorque - p.T_s) / (p.D + p.b * creep_per_psi);
  // While the pump sticks, d(dp)/dt = -(beta/V_ms)(2 c_I + c_E) dp by eqs. (13), (14), both valves closed.
  study->leak_rate = p.beta / p.V_ms * (2 * p.c_I + p.c_E);
  study->slip_dp = (kStickSlipTorque - study->static_torque) / p.D;
  study->largest_static = p.T_s + study->threshold_ratio * (kFasterTorque - p.T_s);
}

StickSlipStudy RunStickSlipStudy(const ExperimentOptions& options) {
  const model::ModelDescription table1 = ShippedModel("table1");
  const model::ModelDescription stribeck = ShippedModel("table1_stribeck");
  StickSlipStudy study;
  study.p = table1.parameters;
  study.excess = stribeck.effects.at(0).parameters.at("static_excess");
  study.speed = stribeck.effects.at(0).parameters.at("speed");
  study.static_torque = study.p.T_s * (1 + study.excess);

  study.plain = RunOpenLoop(table1, kStickSlipTorque, kStickSlipDuration);
  study.cycling = RunOpenLoop(stribeck, kStickSlipTorque, kStickSlipDuration);
  study.cycles = FindCycles(study.cycling);
  options.progress(0.2);
  ScanTable1(table1, &study);
  options.progress(0.4);
  study.threshold = FindThreshold();
  study.threshold_ratio = (study.threshold.cycles - study.p.T_s) / (kStickSlipTorque - study.p.T_s);
  options.progress(0.6);
  ScanStaticFriction(stribeck, &study);
  options.progress(0.9);
  SolveInClosedForm(&study);
  return study;
}

std::string Conditions(const StickSlipStudy& study) {
  return fmt::format(
      "Clamped at α = 0, from rest at p_1 = p_2 = p_3 = {} psi, constant T_p = {} in-lbf for {} s, open "
      "loop. Table 1 alone, and Table 1 with static friction {:.0f} % above kinetic, falling off over {} "
      "rad/s (pump.stribeck, assumed: the paper measures neither). Sticks are counted from the model's own "
      "changes of mode, located within {} us.",
      study.p.p_3, kStickSlipTorque, kStickSlipDuration, 100 * study.excess, study.speed,
      kLocatedWithin * 1e6);
}

std::string Explanation(const StickSlipStudy& study) {
  return fmt::format(
      "Table 1 alone cannot do this at any torque. With equal static and kinetic friction, its equations "
      "from rest at p_3 contain the torque only as T_p - T_s, so 4.1 in-lbf gives the curve of 10 in-lbf, "
      "scaled. Each sticks once (at {stick_time:.3f} s, here with dp = {stick_dp:.1f} psi), waits while "
      "leakage lowers dp, slips at (T_p - T_s)/D = {slip_dp:.1f} psi at {slip_time:.3f} s, and then creeps "
      "at the speed that makes up for the leakage. A pump that slips as soon as the torques balance has "
      "nothing to drive it further. Static friction above kinetic does drive it further: with "
      "{static_torque:.1f} in-lbf at rest the pump sticks {sticks} times in {duration} s, every {period:.2f} "
      "s, with dp between {low:.0f} and {high:.0f} psi, which is Figure 2's behaviour. Cycles need an excess "
      "of {threshold_ratio:.3f} (T_p - T_s), so at a given static friction they end as the torque grows, as "
      "the paper says. To cycle at {torque} but not at {faster_torque} in-lbf, as Figures 2 and 3 do, "
      "friction that is higher only at rest must be between {threshold:.2f} and {largest_static:.2f} in-lbf; "
      "the {static_torque:.1f} shipped as an assumption cycles at both.",
      fmt::arg("stick_time", study.stick().time), fmt::arg("stick_dp", study.stick().dp),
      fmt::arg("slip_dp", study.slip().dp), fmt::arg("slip_time", study.slip().time),
      fmt::arg("static_torque", study.static_torque), fmt::arg("sticks", study.cycling.sticks()),
      fmt::arg("duration", kStickSlipDuration), fmt::arg("period", study.cycles.period),
      fmt::arg("low", study.cycles.low), fmt::arg("high", study.cycles.high),
      fmt::arg("threshold_ratio", study.threshold_ratio), fmt::arg("torque", kStickSlipTorque),
      fmt::arg("faster_torque", kFasterTorque), fmt::arg("threshold", study.threshold.cycles),
      fmt::arg("largest_static", study.largest_static));
}

std::vector<Comparison> Comparisons(const StickSlipStudy& study) {
  return {{"sticks, Table 1 alone", "", "sustained cycles", 1, static_cast<double>(study.plain.sticks()),
           "the paper's equations do not cycle: one stick, then creep"},
          {"dp when it slips again, Table 1 alone", "psi", "", (kStickSlipTorque - study.p.T_s) / study.p.D,
           study.slip().dp, "expected: (T_p - T_s)/D"},
          {"how long that stick lasts, Table 1 alone", "s", "",
           std::log(study.stick().dp / study.slip().dp) / study.leak_rate,
           study.slip().time - study.stick().time, "expected: dp leaks at (β/V_ms)(2 c_I + c_E)"},
          {"dp at the end, Table 1 alone", "psi", "", study.creep_dp, study.plain.dp.back(),
           "expected: steady creep, side 1 held at p_3"},
          {"sticks with static above kinetic friction", "", "sustained cycles", page::kAutomatic,
           static_cast<double>(study.cycling.sticks()), fmt::format("in {} s", kStickSlipDuration)},
          {"period of the cycles", "s", "", page::kAutomatic, study.cycles.period,
           "follows from the assumed friction"},
          {"dp at each slip of the cycles", "psi", "", study.slip_dp, study.cycles.slip_dp,
           "expected: (T_p - T_static)/D"},
          {"how long each stick of the cycles lasts", "s", "",
           std::log(study.cycles.stick_dp / study.cycles.slip_dp) / study.leak_rate, study.cycles.stick_time,
           "expected: as above"},
          {"static friction that cycles need at 6 in-lbf, at rest only", "in-lbf", "", page::kAutomatic,
           study.threshold.cycles, fmt::format("{:.3f} still creeps", study.threshold.none)}};
}

Finding TableFinding(const StickSlipStudy& study) {
  return {
      3,
      "Figure 2 shows sustained stick-slip, simulated with eqs. (4), (13), (14) and Table 1, and says that "
      "it does not occur at higher torques.",
      fmt::format("Table 1 alone sticks exactly once at each of 4.1, 4.5, 5, 6, 8 and 10 in-lbf, at the same "
                  "{stick_time:.4f} s, and then creeps (dp {end_dp:.1f} psi and {end_speed:.3f} rad/s after "
                  "{duration} s at {torque} in-lbf). With static friction at rest only, {none:.3f} in-lbf "
                  "still creeps and {threshold:.3f} cycles at {torque} in-lbf: an excess of "
                  "{threshold_ratio:.3f} (T_p - T_s). The shipped assumption ({static_torque:.1f} in-lbf, "
                  "{speed} rad/s) cycles every {period:.2f} s between {low:.0f} and {high:.0f} psi.",
                  fmt::arg("stick_time", study.stick().time), fmt::arg("end_dp", study.plain.dp.back()),
                  fmt::arg("end_speed", study.plain.motor_speed.back()),
                  fmt::arg("duration", kStickSlipDuration), fmt::arg("torque", kStickSlipTorque),
                  fmt::arg("none", study.threshold.none), fmt::arg("threshold", study.threshold.cycles),
                  fmt::arg("threshold_ratio", study.threshold_ratio),
                  fmt::arg("static_torque", study.static_torque), fmt::arg("speed", study.speed),
                  fmt::arg("period", study.cycles.period), fmt::arg("low", study.cycles.low),
                  fmt::arg("high", study.cycles.high)),
      "Both are shown. Table 1 stays as printed; config/models/table1_stribeck.toml adds static friction "
      "above kinetic, marked as an assumption."};
}

json Describe(const std::vector<Scanned>& scans, double kinetic) {
  json out = json::array();
  for (const Scanned& scanned : scans) out.push_back(Describe(scanned, kinetic));
  return out;
}

json Numbers(const StickSlipStudy& study) {
  return {{"torque_in_lbf", kStickSlipTorque},
          {"duration_s", kStickSlipDuration},
          {"table1",
           {{"sticks", study.plain.sticks()},
            {"stick_time_s", study.stick().time},
            {"stick_dp_psi", study.stick().dp},
            {"slip_time_s", study.slip().time},
            {"slip_dp_psi", study.slip().dp},
            {"final_dp_psi", study.plain.dp.back()},
            {"final_motor_speed_rad_s", study.plain.motor_speed.back()},
            {"by_torque", Describe(study.plain_scan, study.p.T_s)}}},
          {"stribeck",
           {{"static_excess", study.excess},
            {"speed_rad_s", study.speed},
            {"static_torque_in_lbf", study.static_torque},
            {"sticks", study.cycling.sticks()},
            {"period_s", study.cycles.period},
            {"swing_psi", study.cycles.high - study.cycles.low},
            {"high_psi", study.cycles.high},
            {"low_psi", study.cycles.low},
            {"stick_dp_psi", study.cycles.stick_dp},
            {"slip_dp_psi", study.cycles.slip_dp},
            {"stick_duration_s", study.cycles.stick_time},
            {"by_torque", Describe(study.stribeck_scan, study.p.T_s)}}},
          {"at_rest_only",
           {{"speed_rad_s", kAtRestOnly},
            {"largest_static_torque_without_cycles_in_lbf", study.threshold.none},
            {"smallest_static_torque_with_cycles_in_lbf", study.threshold.cycles},
            {"threshold_excess_ratio", study.threshold_ratio},
            {"largest_static_torque_without_cycles_at_10_in_lbf", study.largest_static},
            {"scan", Describe(study.at_rest, study.p.T_s)}}}};
}

std::vector<tables::Column> Columns(const StickSlipStudy& study) {
  const size_t rows = static_cast<size_t>(std::lround(kPictured / 1e-3)) + 1;
  const auto head = [&](const std::vector<double>& values) {
    return std::vector<double>(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(rows));
  };
  return {{"time_s", head(study.plain.time)},
          {"table1_dp_psi", head(study.plain.dp)},
          {"table1_p1_psi", head(study.plain.p1)},
          {"table1_p2_psi", head(study.plain.p2)},
          {"table1_motor_speed_rad_s", head(study.plain.motor_speed)},
          {"stribeck_dp_psi", head(study.cycling.dp)},
          {"stribeck_p1_psi", head(study.cycling.p1)},
          {"stribeck_p2_psi", head(study.cycling.p2)},
          {"stribeck_motor_speed_rad_s", head(study.cycling.motor_speed)}};
}

Picture CyclesPicture(const StickSlipStudy& study) {
  page::Panel once = DpPanel("Table 1 alone: one stick, then creep", {DpCurve(study.plain, "", 0)},
                             ChangeNotes(study.plain, 2));
  page::Panel often =
      DpPanel(fmt::format("Static friction {:.0f} % above kinetic: sustained stick-slip", 100 * study.excess),
              {DpCurve(study.cycling, "", 0)}, {});
  once.rules = {{"(T_p - T_s)/D", false, (kStickSlipTorque - study.p.T_s) / study.p.D}};
  often.rules = {{"(T_p - T_static)/D: slips", false, study.slip_dp}};
  return {"",
          {.caption = fmt::format("Open loop, clamped at α = 0, T_p = {} in-lbf from rest. Above: the "
                                  "paper's equations and Table 1. Below: with static friction of {:.1f} "
                                  "in-lbf, which falls off to {} in-lbf over {} rad/s (assumed).",
                                  kStickSlipTorque, study.static_torque, study.p.T_s, study.speed),
           .panels = {once, often}}};
}

Picture TorquesPicture(const StickSlipStudy& study) {
  return {"-torques",
          {.caption = "Table 1 alone, clamped at α = 0, constant torque from rest: at any torque the pump "
                      "sticks once, at the same time. The curves are in proportion to T_p - T_s.",
           .panels = {DpPanel("Table 1 alone at several torques", study.scaled, {})}}};
}

Picture ScanPicture(const std::vector<Scanned>& scans, double kinetic, double threshold_ratio) {
  page::Curve period{.stroke = page::Stroke::kLinePoints};
  page::Curve high{.label = "highest", .stroke = page::Stroke::kLinePoints};
  page::Curve low{.label = "lowest", .stroke = page::Stroke::kLinePoints};
  for (const Scanned& scanned : scans) {
    if (scanned.torque != kStickSlipTorque || !scanned.cycles.sustained) continue;
    for (page::Curve* curve : {&period, &high, &low}) curve->x.push_back(scanned.ExcessRatio(kinetic));
    period.y.push_back(scanned.cycles.period);
    high.y.push_back(scanned.cycles.high);
    low.y.push_back(scanned.cycles.low);
  }
  const page::Axis ratio{.label = "(T_static - T_s)/(T_p - T_s)", .min = 0, .max = 0.9};
  const page::Rule threshold{fmt::format("no cycles below {:.3f}", threshold_ratio), true, threshold_ratio};
  page::Panel periods{.title = "Period of the cycles",
                      .x = ratio,
                      .y = {.label = "period, s", .min = 0},
                      .curves = {period},
                      .rules = {threshold}};
  page::Panel swings{.title = fmt::format("Extremes of p_2 - p_1 at T_p = {} in-lbf", kStickSlipTorque),
                     .x = ratio,
                     .y = {.label = "p_2 - p_1, psi", .min = 0},
                     .curves = {high, low},
                     .rules = {threshold}};
  return {"-scan",
          {.caption = fmt::format("Static friction above kinetic at rest only (gone at {} rad/s), Table 1 "
                                  "otherwise, clamped at α = 0, T_p = {} in-lbf, second half of {} s.",
                                  kAtRestOnly, kStickSlipTorque, kStickSlipDuration),
           .panels = {periods, swings}}};
}

}  // namespace

ExperimentResult RunFig2(const ExperimentOptions& options) {
  const StickSlipStudy study = RunStickSlipStudy(options);
  ExperimentResult result;
  result.conditions = Conditions(study);
  result.paper_says =
      "At low voltages the pressure fluctuates erratically: after a peak, friction holds the rotor until "
      "leakage has lowered the pressure enough for the torque to turn the pump again. Figure 2 simulates "
      "this; at higher torques it does not occur.";
  result.explanation = Explanation(study);
  result.comparisons = Comparisons(study);
  result.findings = {TableFinding(study)};
  result.numbers = JsonText(Numbers(study));
  result.table.columns = Columns(study);
  result.pictures = {CyclesPicture(study), TorquesPicture(study),
                     ScanPicture(study.at_rest, study.p.T_s, study.threshold_ratio)};
  options.progress(1);
  return result;
}

}  // namespace hydro::experiments
