// Figure 3: the clamped actuator's response to a step of 10 in-lbf, open loop.
#include <spdlog/fmt/fmt.h>

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "experiments/figures/catalogue.h"
#include "experiments/runs/open_loop_run.h"
#include "experiments/runs/shipped_models.h"
#include "experiments/studies/experiment.h"
#include "model/equations/equations.h"
#include "model/integrate/runge_kutta.h"

namespace hydro::experiments {
namespace {

using nlohmann::json;

constexpr double kAppliedTorque = 10;    // in-lbf
constexpr double kOpenLoopDuration = 3;  // s

// The second-order response of eqs. (4) and (14) while the pump turns forward and the valve holds p_1 at p_3:
// from rest to the first peak, in closed form.
struct SpringAnalogy {
  double natural_frequency = 0;  // rad/s, undamped and without leakage
  double damping_ratio = 0;
  double peak_time = 0;  // s
  double peak_dp = 0;    // psi
};
SpringAnalogy AnalyseSpring(const model::Parameters& p) {
  // J theta'' = T_p - T_s - b theta' - D dp, dp' = s (D theta' - c_L dp).
  const double s = p.beta / p.V_ms;
  const double c_L = p.c_I + p.c_E;
  const double stiffness = s * (p.D * p.D + p.b * c_L) / p.J;  // omega^2 with leakage
  const double decay = (p.b / p.J + s * c_L) / 2;
  SpringAnalogy spring;
  spring.natural_frequency = p.D * std::sqrt(s / p.J);
  spring.damping_ratio = decay / std::sqrt(stiffness);
  spring.peak_time = std::numbers::pi / std::sqrt(stiffness - decay * decay);
  const double final_dp = (kAppliedTorque - p.T_s) * p.D / (p.D * p.D + p.b * c_L);
  spring.peak_dp = final_dp * (1 + std::exp(-decay * spring.peak_time));
  return spring;
}

// The same step without the one-way valves, until the pump first stops: the model's equations with both
// valves held closed.
struct WithoutValves {
  std::vector<double> time, dp, p1, p2;
  size_t peak = 0;            // of dp
  double negative_since = 0;  // s, p_1 < 0
};
WithoutValves RunWithoutValves(const model::ModelDescription& model) {
  constexpr double kStep = 1e-4;  // s; classical Runge-Kutta at 18 rad/s: errors below 1e-9 psi
  const model::Equations equations(model, {.shaft = model::Shaft::kClamped});
  model::Mode mode;
  std::array<double, model::kMaxStates> y{};
  equations.Start(model.parameters.p_3, y.data(), &mode);
  mode.pump = 1;
  const double voltage = kAppliedTorque / model.parameters.k_1;
  const auto rates = [&](double time, const double* at, double* rate) {
    equations.Rates(time, voltage, mode, at, rate);
  };
  std::array<std::array<double, model::kMaxStates>, 4> k{};
  std::array<double, model::kMaxStates> stage{}, next{};
  WithoutValves run;
  for (int i = 0; i == 0 || y[model::kMotorSpeed] > 0; ++i) {
    const double time = i * kStep;
    run.time.push_back(time);
    run.p1.push_back(y[model::kP1]);
    run.p2.push_back(y[model::kP2]);
    run.dp.push_back(y[model::kP2] - y[model::kP1]);
    if (run.dp.back() > run.dp[run.peak]) run.peak = run.dp.size() - 1;
    if (y[model::kP1] < 0 && run.negative_since == 0) run.negative_since = time;
    rates(time, y.data(), k[0].data());
    model::RungeKuttaStep(equations.states(), time, kStep, y.data(), k[0].data(), k[1].data(), k[2].data(),
                          k[3].data(), stage.data(), next.data(), rates);
    y = next;
  }
  return run;
}

struct StepStudy {
  model::Parameters p;
  OpenLoopRun run;
  SpringAnalogy spring;
  WithoutValves bare;
  double leak_rate = 0;  // 1/s: while the pump sticks, d(dp)/dt = -(beta/V_ms)(2 c_I + c_E) dp
  double slip_dp = 0;    // psi, (T_p - T_s)/D

  const PressureExtreme& peak() const { return run.extremes.at(0); }
  const PumpChange& stick() const { return run.changes.at(0); }
  const PumpChange& slip() const { return run.changes.at(1); }
  double bare_dp() const { return bare.dp[bare.peak]; }
};

StepStudy RunOpenLoopStudy() {
  const model::ModelDescription model = ShippedModel("table1");
  const model::Parameters& p = model.parameters;
  return {.p = p,
          .run = RunOpenLoop(model, kAppliedTorque, kOpenLoopDuration),
          .spring = AnalyseSpring(p),
          .bare = RunWithoutValves(model),
          .leak_rate = p.beta / p.V_ms * (2 * p.c_I + p.c_E),
          .slip_dp = (kAppliedTorque - p.T_s) / p.D};
}

std::string Explanation(const StepStudy& study) {
  const model::Parameters& p = study.p;
  const WithoutValves& bare = study.bare;
  return fmt::format(
      "It is a mass on a spring. As soon as the pump turns, p_1 would fall below the accumulator's pressure, "
      "so the valve holds side 1 at {p_3} psi, and the fluid of the other side is the spring: "
      "{natural_frequency:.2f} rad/s, damping ratio {damping_ratio:.3f}. Half a damped period later, at "
      "{peak_time:.4f} s, dp peaks at {peak_dp:.1f} psi, as in closed form. Then the pump almost stands "
      "still, leakage lets p_1 rise again, and at {stick_time:.4f} s the pump sticks: to swing back, dp "
      "would have to overcome friction in the other direction as well, (T_p + T_s)/D = {back_dp:.0f} psi. It "
      "waits {wait:.2f} s while dp leaks to (T_p - T_s)/D = {slip_dp:.1f} psi, and then creeps on. Without "
      "the valves both sides are springs, and dp peaks at nearly the same {bare_dp:.1f} psi. But p_1 would "
      "be negative from {negative_ms:.0f} ms on and reach {bare_p1:.0f} psi, which the paper's accumulator "
      "prevents.",
      fmt::arg("p_3", p.p_3), fmt::arg("natural_frequency", study.spring.natural_frequency),
      fmt::arg("damping_ratio", study.spring.damping_ratio), fmt::arg("peak_time", study.spring.peak_time),
      fmt::arg("peak_dp", study.peak().dp), fmt::arg("stick_time", study.stick().time),
      fmt::arg("back_dp", (kAppliedTorque + p.T_s) / p.D),
      fmt::arg("wait", study.slip().time - study.stick().time), fmt::arg("slip_dp", study.slip().dp),
      fmt::arg("bare_dp", study.bare_dp()), fmt::arg("negative_ms", 1e3 * bare.negative_since),
      fmt::arg("bare_p1", bare.p1[bare.peak]));
}

std::vector<Comparison> Comparisons(const StepStudy& study) {
  const model::Parameters& p = study.p;
  const WithoutValves& bare = study.bare;
  return {{"peak of p_2", "psi", "", p.p_3 + study.spring.peak_dp, study.peak().p2,
           "expected: closed form, one side at p_3"},
          {"peak of dp", "psi", "", study.spring.peak_dp, study.peak().dp, ""},
          {"time of the peak", "s", "", study.spring.peak_time, study.peak().time,
           "expected: half a damped period"},
          {"pump sticks", "s", "", page::kAutomatic, study.stick().time,
           "after the peak the valve closes and both sides compress: no closed form"},
          {"dp when it slips again", "psi", "", study.slip_dp, study.slip().dp, "expected: (T_p - T_s)/D"},
          {"pump slips again", "s", "",
           study.stick().time + std::log(study.stick().dp / study.slip_dp) / study.leak_rate,
           study.slip().time, "expected: from the stick on, dp leaks at (β/V_ms)(2 c_I + c_E)"},
          {"peak of dp without the valves", "psi", "", page::kAutomatic, study.bare_dp(), ""},
          {"p_2 then", "psi", "", page::kAutomatic, bare.p2[bare.peak], ""},
          {"p_1 then", "psi", "", page::kAutomatic, bare.p1[bare.peak],
           "no fluid withstands that: it would cavitate"}};
}

json Numbers(const StepStudy& study) {
  const WithoutValves& bare = study.bare;
  return {{"torque_in_lbf", kAppliedTorque},
          {"peak_p2_psi", study.peak().p2},
          {"peak_dp_psi", study.peak().dp},
          {"peak_time_s", study.peak().time},
          {"stick_time_s", study.stick().time},
          {"stick_dp_psi", study.stick().dp},
          {"slip_time_s", study.slip().time},
          {"slip_dp_psi", study.slip().dp},
          {"sticks", study.run.sticks()},
          {"natural_frequency_rad_s", study.spring.natural_frequency},
          {"damping_ratio", study.spring.damping_ratio},
          {"closed_form_peak_time_s", study.spring.peak_time},
          {"closed_form_peak_dp_psi", study.spring.peak_dp},
          {"without_valves",
           {{"peak_dp_psi", study.bare_dp()},
            {"peak_time_s", bare.time[bare.peak]},
            {"p2_psi", bare.p2[bare.peak]},
            {"p1_psi", bare.p1[bare.peak]},
            {"p1_negative_from_s", bare.negative_since}}}};
}

std::vector<page::Panel> Panels(const StepStudy& study) {
  const PressureExtreme& peak = study.peak();
  const PumpChange& stick = study.stick();
  const PumpChange& slip = study.slip();
  const WithoutValves& bare = study.bare;
  const page::Axis time{.label = "time, s", .min = 0, .max = kOpenLoopDuration};
  page::Panel difference{
      .title = "Pressure difference",
      .x = time,
      .y = {.label = "p_2 - p_1, psi", .min = 0},
      .curves = {page::Line("", study.run.time, study.run.dp, 0)},
      .notes = {{fmt::format("peak {:.1f} psi at {:.4f} s; sticks at {:.4f} s", peak.dp, peak.time,
                             stick.time),
                 peak.time, peak.dp},
                {fmt::format("slips at {:.3f} s, {:.1f} psi", slip.time, slip.dp), slip.time, slip.dp}},
      .rules = {{"(T_p - T_s)/D", false, study.slip_dp}}};
  page::Panel sides{
      .title = "The two sides",
      .x = time,
      .y = {.label = "pressure, psi"},
      .curves = {
          page::Line("p_2", study.run.time, study.run.p2, 0),
          page::Line("p_1", study.run.time, study.run.p1, 1),
          page::Line("p_2 without valves, to the first stop", bare.time, bare.p2, 0, page::Stroke::kDashed),
          page::Line("p_1 without valves", bare.time, bare.p1, 1, page::Stroke::kDashed)}};
  return {difference, sides};
}

}  // namespace

ExperimentResult RunFig3(const ExperimentOptions& options) {
  const StepStudy study = RunOpenLoopStudy();
  options.progress(0.9);
  ExperimentResult result;
  result.conditions = fmt::format(
      "Table 1, clamped at α = 0, from rest at p_1 = p_2 = p_3 = {} psi, constant T_p = {} in-lbf ({} V), "
      "open loop. Peak, stick and slip are located within {} us.",
      study.p.p_3, kAppliedTorque, kAppliedTorque / study.p.k_1, kLocatedWithin * 1e6);
  result.paper_says =
      "Figure 3 shows the response to 10 in-lb, experiment and simulation: no sustained stick-slip. The "
      "response is that of a mass-spring-damper to a constant force; the spring is the fluid's "
      "compressibility.";
  result.explanation = Explanation(study);
  result.comparisons = Comparisons(study);
  result.numbers = JsonText(Numbers(study));
  result.table.columns = {{"time_s", study.run.time},
                          {"dp_psi", study.run.dp},
                          {"p1_psi", study.run.p1},
                          {"p2_psi", study.run.p2},
                          {"motor_speed_rad_s", study.run.motor_speed}};
  result.pictures.push_back(
      {"",
       {.caption = fmt::format("Open loop, Table 1, clamped at α = 0, T_p = {} in-lbf from rest at p_1 = p_2 "
                               "= p_3. Dashed: without the one-way valves.",
                               kAppliedTorque),
        .panels = Panels(study)}});
  options.progress(1);
  return result;
}

}  // namespace hydro::experiments
