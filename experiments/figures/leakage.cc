// "Open and closed-loop experiments": c_E and c_I fitted by simulation to clamped open-loop runs.
#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "base/maths/linear_fit.h"
#include "experiments/figures/catalogue.h"
#include "experiments/runs/shipped_models.h"
#include "experiments/studies/experiment.h"
#include "experiments/studies/leakage_fit.h"
#include "experiments/studies/paper_units.h"

namespace hydro::experiments {
namespace {

using nlohmann::json;

// Transducers of the simulated rig: noisy, read through a 12-bit converter from 0 to 2000 psi.
constexpr double kPressureNoise = 3;             // psi
constexpr double kPressureStep = 2000.0 / 4096;  // psi
constexpr double kTorques[] = {10, 6, -10, -6};  // in-lbf, one run each
constexpr double kTorqueStart = 0.1;             // s, when the torque steps up
constexpr double kRelease = 2.5;                 // s, when it steps to 0
constexpr double kLeakageDuration = 4.5;         // s

runs::MeasuredRun Measure(const ExperimentOptions& options, size_t index, const model::Parameters& p) {
  const std::string& model = ShippedModelText("table1");
  const std::string config = fmt::format(
      "[model]\nfile = \"table1.toml\"\nshaft = \"clamped\"\n"
      "[time]\nmode = \"lockstep\"\nduration_s = {}\n"
      "[plant]\nrate_hz = 1000\n"
      "[pressure]\nk_p = 0.0\nk_v = 0.0\n"
      "[position]\nsample_interval_s = 0.001\n"
      "[reference]\nsignal = \"voltage\"\nkind = \"steps\"\nsteps = [[{}, {}], [{}, 0.0]]\n"
      "[noise]\nseed = {}\np1 = {}\np2 = {}\np1_resolution = {}\np2_resolution = {}\n",
      kLeakageDuration, kTorqueStart, kTorques[index] / p.k_1, kRelease,
      options.seed + static_cast<int64_t>(index), kPressureNoise, kPressureNoise, kPressureStep,
      kPressureStep);
  tables::Table table = options.run_stack({fmt::format("leakage-{}", index + 1), config, model});
  table.file = fmt::format("{} in-lbf", kTorques[index]);
  return runs::RunOfExport(table, config, model);
}

json Told(const LeakageInformation& information) {
  return {{"c_E_error_percent", 100 * information.c_E_error},
          {"c_I_error_percent", 100 * information.c_I_error},
          {"correlation", information.correlation},
          {"best_told_c_I_weight", information.c_I_weight},
          {"best_told_error_percent", 100 * information.combination_error}};
}

json Numbers(const LeakageFit& fit) {
  json numbers = {{"c_E", fit.c_E.value},
                  {"c_I", fit.c_I.value},
                  {"unit", "in^3/(s psi)"},
                  {"ci95", {{"c_E", IntervalJson(fit.c_E)}, {"c_I", IntervalJson(fit.c_I)}}},
                  {"correlation", fit.information.correlation},
                  {"not_identifiable", fit.not_identifiable},
                  {"best_told",
                   {{"c_I_weight", fit.information.c_I_weight},
                    {"value", fit.combination.value},
                    {"ci95", IntervalJson(fit.combination)}}},
                  {"rms_residual", fit.rms},
                  {"converged", fit.converged},
                  {"told_by",
                   {{"all", Told(fit.information)},
                    {"both_sides_above_p_3", Told(fit.floating)},
                    {"one_side_at_p_3", Told(fit.held)},
                    {"dp_only", Told(fit.all_difference)},
                    {"both_sides_above_p_3_dp_only", Told(fit.floating_difference)},
                    {"one_side_at_p_3_dp_only", Told(fit.held_difference)}}}};
  for (const LeakageShift& shift : fit.shifts) {
    numbers["shift_percent_for_1_percent"][shift.parameter] = {{"c_E", shift.c_E_percent},
                                                               {"c_I", shift.c_I_percent}};
  }
  return numbers;
}

page::Curve Empty(const std::string& label, page::Stroke stroke, int colour) {
  return {.label = label, .stroke = stroke, .colour = colour};
}

// Measured and simulated dp, the pressure of the side that the pump draws from, and the residuals.
Picture FitPicture(const std::vector<runs::MeasuredRun>& runs, const LeakageFit& fit, double p_3,
                   const std::string& caption) {
  const page::Axis time{.label = "time, s"};
  page::Panel dp{.title = "Pressure difference: measured (one sample in 60) and fitted (lines)",
                 .x = time,
                 .y = {.label = "p_2 - p_1, psi"},
                 .height = 1.6};
  page::Panel low{
      .title =
          "The lower of the two pressures, above the accumulator's: leakage into it while the pump "
          "sticks",
      .x = time,
      .y = {.label = "min(p_1, p_2) - p_3, psi"}};
  page::Panel residuals{.title = "Measured minus fitted, p_2 - p_1",
                        .x = time,
                        .y = {.label = "standard deviations of the noise"},
                        .rules = {{"", false, 0}}};
  for (size_t r = 0; r < runs.size(); ++r) {
    const runs::MeasuredRun& run = runs[r];
    const SimulatedRun& model = fit.simulated[r];
    const int colour = static_cast<int>(r);
    page::Curve dots = Empty("", page::Stroke::kPoints, colour),
                line = Empty(run.name, page::Stroke::kLine, colour);
    page::Curve low_dots = dots, low_line = Empty("", page::Stroke::kLine, colour), rest = dots;
    const double noise = std::hypot(fit.p1_noise[r], fit.p2_noise[r]);
    for (size_t i = 0; i < run.samples(); ++i) {
      const double modelled = model.p2[i] - model.p1[i];
      line.x.push_back(run.time[i]);
      line.y.push_back(modelled);
      low_line.x.push_back(run.time[i]);
      low_line.y.push_back(std::min(model.p1[i], model.p2[i]) - p_3);
      if (i % 60 != 15 * r % 60) continue;
      const double measured = run.p2.values[i] - run.p1.values[i];
      for (page::Curve* curve : {&dots, &low_dots, &rest}) curve->x.push_back(run.time[i]);
      dots.y.push_back(measured);
      // Take the side that is lower in the model: the lower of two readings of equal pressures is biased.
      low_dots.y.push_back((model.p1[i] < model.p2[i] ? run.p1 : run.p2).values[i] - p_3);
      rest.y.push_back((measured - modelled) / noise);
    }
    dp.curves.push_back(dots);
    dp.curves.push_back(line);
    low.curves.push_back(low_dots);
    low.curves.push_back(low_line);
    residuals.curves.push_back(rest);
  }
  return {"", {.caption = caption, .panels = {dp, low, residuals}}};
}

// All runs one after the other, as measured and as simulated.
tables::Table FitTable(const std::vector<runs::MeasuredRun>& runs, const LeakageFit& fit) {
  tables::Table table;
  table.columns = {
      {"run", {}},    {"time_s", {}},        {"voltage_V", {}},     {"p1_psi", {}},
      {"p2_psi", {}}, {"fitted_p1_psi", {}}, {"fitted_p2_psi", {}}, {"fitted_motor_speed_rad_s", {}}};
  for (size_t r = 0; r < runs.size(); ++r) {
    const runs::MeasuredRun& run = runs[r];
    const SimulatedRun& model = fit.simulated[r];
    for (size_t i = 0; i < run.samples(); ++i) {
      const double row[] = {
          static_cast<double>(r + 1), run.time[i], run.voltage.values[i], run.p1.values[i],
          run.p2.values[i],           model.p1[i], model.p2[i],           model.motor_speed[i]};
      for (size_t k = 0; k < table.columns.size(); ++k) table.columns[k].values.push_back(row[k]);
    }
  }
  return table;
}

// A run's first stick in closed form: with both valves closed, p_1 + p_2 - 2 p_3 decays at the rate (beta/V)
// c_E and p_2 - p_1 at (beta/V)(c_E + 2 c_I).
struct StickDecay {
  double c_E = 0;
  double c_I = 0;
  double from = 0, to = 0;  // s
};
StickDecay FitStick(const runs::MeasuredRun& run, const SimulatedRun& model, const model::Parameters& p) {
  std::vector<double> one, time, sum, difference;
  size_t i = 0;
  while (i < run.samples() && model.motor_speed[i] == 0) ++i;  // at rest before the step
  while (i < run.samples() && model.motor_speed[i] != 0) ++i;
  for (; i < run.samples() && model.motor_speed[i] == 0; ++i) {
    one.push_back(1);
    time.push_back(run.time[i]);
    sum.push_back(std::log(run.p1.values[i] + run.p2.values[i] - 2 * p.p_3));
    difference.push_back(std::log(std::abs(run.p2.values[i] - run.p1.values[i])));
  }
  const double V = p.V_ms;  // at mid-stroke
  StickDecay decay;
  decay.c_E = -maths::FitLinear({one, time}, sum).coefficients[1] * V / p.beta;
  decay.c_I = (-maths::FitLinear({one, time}, difference).coefficients[1] * V / p.beta - decay.c_E) / 2;
  decay.from = time.front();
  decay.to = time.back();
  return decay;
}

// Mean reading of the side that the pump draws from, while the pump creeps before the release.
double LowSideWhileCreeping(const runs::MeasuredRun& run) {
  const std::vector<double>& low = (run.voltage.values[run.samples() / 4] > 0 ? run.p1 : run.p2).values;
  double sum = 0;
  int count = 0;
  for (size_t i = 0; i < run.samples(); ++i) {
    if (run.time[i] < kRelease - 0.5 || run.time[i] > kRelease) continue;
    sum += low[i];
    ++count;
  }
  return sum / count;
}

std::string Identifiability(const LeakageFit& fit) {
  if (fit.not_identifiable.empty()) {
    return fmt::format("The two can be told apart (correlation of their errors {:.2f}).",
                       fit.information.correlation);
  }
  std::string names = fit.not_identifiable.front();
  if (fit.not_identifiable.size() > 1) names += " and " + fit.not_identifiable.back();
  return fmt::format(
      "NOT told apart: the interval of {} is wider than +/- 25 % (correlation {:.3f}). These data determine "
      "c_E + {:.2f} c_I = {} in^3/(s psi): only that sum has an effect where the low side stays at p_3 "
      "(weight 1) or only p_2 - p_1 decays (weight 2). A run in which the pump sticks for long with both "
      "sides above p_3 would separate them.",
      names, fit.information.correlation, fit.information.c_I_weight, maths::PlusMinus(fit.combination));
}

constexpr char kPaperSays[] =
    "c_E and c_I were adjusted until the simulated pressure difference agreed fairly well with that of the "
    "clamped actuator after a step of voltage.";

// Residuals beyond this many standard deviations of the noise mean that the fit compensates for something
// that the model lacks.
constexpr double kDescribed = 5;
constexpr char kNotDescribed[] =
    "NEITHER is to be believed: the model does not describe this run with any leakage. A wrong scale of a "
    "pressure or of the voltage, a wrong k_1, T_s or beta, or an effect that the model lacks would cause "
    "that.";

ExperimentResult AnalyseMeasuredLeakage(const ExperimentOptions& options) {
  const auto& [run, model] = ReadRunAndModel(options.measured_run);
  const std::vector<runs::MeasuredRun> runs = {run};
  const LeakageFit fit = FitLeakage(model, runs);
  const bool described = fit.rms < kDescribed;
  options.progress(0.9);
  ExperimentResult result;
  result.conditions =
      fmt::format("Measured run {}, clamped at {:.4g} {}; all but c_E and c_I as in the model \"{}\".",
                  NameWithCaution(run), run.arm_angle_rad, run.units.UnitFor("rad", 1), model.name);
  result.paper_says = kPaperSays;
  result.explanation = fmt::format(
      "c_E = {}, c_I = {} in^3/(s psi) (95 %, all else known). {} The residuals are {:.2f} times the "
      "noise{}. One direction is enough: leakage does not depend on it.",
      maths::PlusMinus(fit.c_E), maths::PlusMinus(fit.c_I), described ? Identifiability(fit) : kNotDescribed,
      fit.rms,
      fit.rms > 1.2 ? ", so the model lacks something, and the intervals were widened accordingly" : "");
  json numbers = Numbers(fit);
  numbers["model_describes_run"] = described;
  numbers["source"] = run.file;
  numbers["model"] = model.name;
  result.numbers = JsonText(numbers);
  result.comparisons = {{"c_E", "in^3/(s psi)", "", page::kAutomatic, fit.c_E.value,
                         maths::PlusMinus(fit.c_E) + " in^3/(s psi), 95 %"},
                        {"c_I", "in^3/(s psi)", "", page::kAutomatic, fit.c_I.value,
                         maths::PlusMinus(fit.c_I) + " in^3/(s psi), 95 %"}};
  result.table = FitTable(runs, fit);
  result.pictures.push_back(FitPicture(runs, fit, PaperParameters(model).p_3, result.conditions));
  return result;
}

// The simulated rig's runs, one per torque.
std::vector<runs::MeasuredRun> MeasureAll(const ExperimentOptions& options, const model::Parameters& p) {
  std::vector<runs::MeasuredRun> runs;
  for (size_t i = 0; i < std::size(kTorques); ++i) {
    runs.push_back(Measure(options, i, p));
    runs.back().name = runs.back().file;
  }
  return runs;
}

std::string Explanation(const LeakageFit& fit) {
  const auto shift = [&](const std::string& name) {
    return *std::find_if(fit.shifts.begin(), fit.shifts.end(),
                         [&](const LeakageShift& one) { return one.parameter == name; });
  };
  return fmt::format(
      "Levenberg-Marquardt on both logarithms gives c_E = {c_E} and c_I = {c_I} in^3/(s psi) (95 %, all else "
      "known); the residuals are {residuals:.3f} times the noise. {identifiability} While the pump sticks "
      "both valves are closed; then p_1 + p_2 - 2 p_3 decays with β c_E/V and p_2 - p_1 with β (c_E + 2 "
      "c_I)/V: the sum of the pressures gives c_E, their difference c_E + 2 c_I. With p_2 - p_1 alone, as on "
      "the paper's oscilloscope, these runs determine c_E + {c_I_weight:.2f} c_I best, and c_I is known "
      "within {dp_error:.2g} % instead of {error:.2g} % (standard errors; correlation {correlation:.2f}); it "
      "is known at all only from the swings and from when they begin. A run that shows nothing but steady "
      "creep, with one side at p_3, gives only c_E + c_I. The rest of Table 1 is taken as exact, and its "
      "errors matter more than the noise: 1 % more β changes c_E by {beta_c_E:.1f} % and c_I by "
      "{beta_c_I:.1f} %, 1 % more T_s by {T_s_c_E:.1f} % and {T_s_c_I:.1f} %, 1 % more k_1 by {k_1_c_E:.1f} "
      "% and {k_1_c_I:.1f} %.",
      fmt::arg("c_E", maths::PlusMinus(fit.c_E)), fmt::arg("c_I", maths::PlusMinus(fit.c_I)),
      fmt::arg("residuals", fit.rms), fmt::arg("identifiability", Identifiability(fit)),
      fmt::arg("c_I_weight", fit.all_difference.c_I_weight),
      fmt::arg("dp_error", 100 * fit.all_difference.c_I_error),
      fmt::arg("error", 100 * fit.information.c_I_error),
      fmt::arg("correlation", fit.all_difference.correlation),
      fmt::arg("beta_c_E", shift("beta").c_E_percent), fmt::arg("beta_c_I", shift("beta").c_I_percent),
      fmt::arg("T_s_c_E", shift("T_s").c_E_percent), fmt::arg("T_s_c_I", shift("T_s").c_I_percent),
      fmt::arg("k_1_c_E", shift("k_1").c_E_percent), fmt::arg("k_1_c_I", shift("k_1").c_I_percent));
}

std::vector<Comparison> Comparisons(const LeakageFit& fit, const StickDecay& decay,
                                    const model::Parameters& p) {
  return {{"c_E", "in^3/(s psi)", "6.5e-6", p.c_E, fit.c_E.value, maths::PlusMinus(fit.c_E) + ", 95 %"},
          {"c_I", "in^3/(s psi)", "1.0e-6", p.c_I, fit.c_I.value, maths::PlusMinus(fit.c_I) + ", 95 %"},
          {"c_E from the first stick", "in^3/(s psi)", "6.5e-6", p.c_E, decay.c_E,
           "closed form: decay of p_1 + p_2 - 2 p_3"},
          {"c_I from the first stick", "in^3/(s psi)", "1.0e-6", p.c_I, decay.c_I,
           "closed form: decay of p_2 - p_1, less that of the sum"},
          {"residuals, in noise", "", "", 1, fit.rms, "1: only the sensors' noise is left"}};
}

Finding NamesFinding(const LeakageFit& fit, size_t runs, double low, double p_3) {
  return {
      10, "The text adjusts \"c_E and c_f in (11) and (12)\"; Table 1 lists \"p_s\".",
      fmt::format(
          "With c_E and c_I, the only coefficients of (11) and (12), the model explains {} clamped runs to "
          "{:.3f} times their noise: no third coefficient is missing. While the pump creeps, the side that "
          "it draws from stays at {:.2f} psi: Table 1's p_s = {} psi is what (11) and (12) call p_3.",
          runs, fit.rms, low, p_3),
      "c_f is read as c_I, p_s as p_3."};
}

}  // namespace

ExperimentResult RunLeakage(const ExperimentOptions& options) {
  if (!options.measured_run.empty()) return AnalyseMeasuredLeakage(options);
  const model::ModelDescription model = ShippedModel("table1");
  const model::Parameters& p = model.parameters;
  const std::vector<runs::MeasuredRun> runs = MeasureAll(options, p);
  options.progress(0.2);
  const LeakageFit fit = FitLeakage(model, runs);
  options.progress(0.9);
  const StickDecay decay = FitStick(runs.front(), fit.simulated.front(), p);
  const double low = LowSideWhileCreeping(runs.front());

  ExperimentResult result;
  result.conditions = fmt::format(
      "Table 1, clamped at α = 0, over the stack at 1 kHz, open loop: T_p = 10, 6, -10 and -6 in-lbf from {} "
      "to {} s, then none. Pressures read with {} psi of noise in steps of {:.3f} psi.",
      kTorqueStart, kRelease, kPressureNoise, kPressureStep);
  result.paper_says = kPaperSays;
  result.explanation = Explanation(fit);
  json numbers = Numbers(fit);
  numbers["source"] = "simulated rig";
  numbers["stick_decay"] = {
      {"c_E", decay.c_E}, {"c_I", decay.c_I}, {"from_s", decay.from}, {"to_s", decay.to}};
  numbers["low_side_while_creeping_psi"] = low;
  result.numbers = JsonText(numbers);
  result.comparisons = Comparisons(fit, decay, p);
  result.findings = {NamesFinding(fit, runs.size(), low, p.p_3)};
  result.table = FitTable(runs, fit);
  result.pictures.push_back(FitPicture(runs, fit, p.p_3,
                                       fmt::format("{} c_E = {}, c_I = {} in^3/(s psi).", result.conditions,
                                                   maths::PlusMinus(fit.c_E), maths::PlusMinus(fit.c_I))));
  options.progress(1);
  return result;
}

}  // namespace hydro::experiments
