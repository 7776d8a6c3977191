#include "experiments/figures/fig10_runs.h"

#include <spdlog/fmt/fmt.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "base/units.h"
#include "experiments/runs/shipped_models.h"
#include "experiments/studies/position_loop.h"
#include "settings/model_file.h"
#include "tune/design/arm_loop.h"

namespace hydro::experiments {
namespace {

constexpr double kInterval = kFigure10Interval;
constexpr double kStepStart = 0.1;           // s, when the reference steps
constexpr double kMotorSpeed = 6000 * kRpm;  // rad/s: "a larger 6000 rpm motor"
constexpr double kNoLimit = 1e6;             // in-lbf

runs::StepResponse Measure(const design::Response& response, double step) {
  return runs::MeasureStep(response.time, response.angle, 0, response.time.size(), 0, step);
}

// The error at which the pump holds the arm under eqs. (16) and (17), approached from below: the pump keeps
// turning forward just fast enough to compensate the leakage, so friction acts in full. dp holds the arm's
// weight.
double HoldingError(const model::Parameters& p, const pressure_ctrl::PressureLawSettings& law, double c1,
                    double angle) {
  const double dp = p.mgl * std::cos(angle) / p.k_2;
  const double creep = (p.c_I + p.c_E) * dp / p.D;  // rad/s, with side 1 at p_3
  const double torque = p.T_s + p.b * creep + p.D * dp;
  const double demand = torque / p.k_1 + law.gains.k_p * (dp + law.gains.k_v * creep);  // V
  return -demand / (law.gains.k_p + law.reference_feedforward) / c1;
}

// The paper's stack with Figure 10's gains and step.
std::string Figure10Stack(const Figure10Runs& figure, const std::vector<std::string>& more) {
  std::vector<std::string> settings = {fmt::format("position.c1={:.17g}", figure.c1),
                                       fmt::format("position.c2={:.17g}", figure.c2),
                                       fmt::format("position.sample_interval_s={}", kInterval),
                                       fmt::format("reference.steps=[[{}, {}]]", kStepStart, kFigure10Step)};
  settings.insert(settings.end(), more.begin(), more.end());
  return ShippedStackText("paper", settings);
}

FormRuns RunForm(const Figure10Runs& figure, design::DerivativeForm form, const StackRunner& run_stack) {
  const int points = static_cast<int>(std::lround(kInterval * 5000));
  const char* name = form == design::DerivativeForm::kError ? "error" : "measurement";
  FormRuns runs;
  runs.linear = design::SampledStep(figure.design, kPaperGain, kInterval, form, kFigure10Step, 2, points);
  runs.linear_step = Measure(runs.linear, kFigure10Step);
  runs.nonlinear =
      RunArm(run_stack, fmt::format("fig10-{}", name),
             Figure10Stack(figure, {fmt::format("position.derivative={}", name), "time.duration_s=5.1"}),
             figure.model, kFigure10Step);
  return runs;
}

// Runs the full model with one cause after the other switched off.
CauseRuns RunCauses(const Figure10Runs& figure, const ExperimentOptions& options) {
  CauseRuns causes;
  for (size_t i = 0; i < kCauses.size(); ++i) {
    const Cause& cause = kCauses[i];
    model::ModelDescription model = figure.model;
    std::vector<std::string> settings = {"position.derivative=measurement", "limits.pressure=inf"};
    if (!cause.friction) model.parameters.T_s = 0;
    if (!cause.saturation) model.parameters.T_pmax = kNoLimit;
    if (!cause.speed_coupling) settings.push_back("pressure.arm_speed_feedforward=true");
    if (!cause.arm_flow) {
      // In this case both sides compress as well: p_1 stays above p_3.
      model.parameters.c *= 1e-9;
      settings.push_back("model.initial_pressure=5000");
    }
    causes.runs[i] = RunArm(options.run_stack, fmt::format("fig10-{}", cause.key),
                            Figure10Stack(figure, settings), model, kFigure10Step);
    options.progress(0.3 + 0.05 * static_cast<double>(i + 1));
  }
  const model::Parameters& p = figure.model.parameters;
  pressure_ctrl::PressureLawSettings law;
  law.gains = pressure_ctrl::DerivePressureGains(p, 0, figure.design.natural_frequency,
                                                 figure.design.damping_ratio, 2);
  pressure_ctrl::PressureLawSettings assisted = law;
  assisted.arm_speed_ratio = p.c / p.D;
  const auto exact = [&](const pressure_ctrl::PressureLawSettings& with) {
    return Measure(
        design::LinearArmLoop(figure.model, with).Step(figure.c1, figure.c2, kFigure10Step, 4, 1e-3),
        kFigure10Step);
  };
  causes.exact = exact(law);
  causes.exact_assisted = exact(assisted);
  causes.friction_error = -HoldingError(p, law, figure.c1, 0);
  return causes;
}

std::string RetunedStack(const RetunedStep& r, int64_t seed) {
  std::vector<std::string> settings = {fmt::format("reference.steps=[[{}, {}]]", kStepStart, r.step),
                                       "time.duration_s=2.1"};
  if (r.noise) {  // as in config/demo.toml
    for (const char* noise : {"p1=1", "p2=1", "motor_speed=0.1", "arm_angle=0.00002", "arm_speed=0.0002"}) {
      settings.push_back(std::string("noise.") + noise);
    }
    settings.push_back(fmt::format("noise.seed={}", seed));
  }
  // With gravity, the arm first settles where it hangs at 0.
  if (r.gravity) {
    settings[0] = fmt::format("reference.steps=[[2.0, {}]]", r.step);
    settings[1] = "time.duration_s=5.0";
  }
  return ShippedStackText("retuned", settings);
}

double SettlingTime(const ArmRun& run) { return run.response.settling_time_s.value_or(page::kAutomatic); }

// Runs the retuned loop on other steps, with noise and with gravity.
void RunSteps(const model::ModelDescription& model, const ExperimentOptions& options, RetunedRuns* retuned) {
  const model::ModelDescription heavy = ShippedModel("table1_gravity");
  retuned->steps = {{"0.05 rad", 0.05, false, false, {}, 0},
                    {"0.1 rad", 0.1, false, false, {}, 0},
                    {"0.2 rad", 0.2, false, false, {}, 0},
                    {"0.3 rad", 0.3, false, false, {}, 0},
                    {"0.1 rad, noisy sensors", 0.1, false, true, {}, 0},
                    {"0.1 rad, with gravity", 0.1, true, false, {}, 0}};
  for (RetunedStep& r : retuned->steps) {
    r.run = RunArm(options.run_stack, "fig10-retuned-" + std::to_string(&r - retuned->steps.data()),
                   RetunedStack(r, options.seed), r.gravity ? heavy : model, r.step);
    r.shortest = design::FastestSettling(retuned->drive, r.step, runs::kSettlingBand);
    if (!r.gravity) retuned->worst_ratio = std::max(retuned->worst_ratio, SettlingTime(r.run) / r.shortest);
  }
  const runs::StepResponse& sagging = retuned->steps.back().run.response;
  retuned->expected_error =
      HoldingError(heavy.parameters, retuned->shipped.pressure, retuned->shipped.position.c1,
                   kFigure10Step + sagging.final_error_rad);
}

RetunedRuns RunRetuned(const model::ModelDescription& model, const ExperimentOptions& options) {
  RetunedRuns retuned;
  retuned.drive = design::MakeRigidDrive(model.parameters, kMotorSpeed);
  retuned.fastest = design::FastestRestToRest(retuned.drive, kFigure10Step);
  retuned.shortest = design::FastestSettling(retuned.drive, kFigure10Step, runs::kSettlingBand);
  retuned.shipped = TrialOf(ShippedStackText("retuned"), ShippedModelText("table1"), kFigure10Step);
  const Candidate best = SearchGains(retuned.shipped, retuned.drive).front();
  retuned.shipped_is_best = best.c1 == retuned.shipped.position.c1 && best.c2 == retuned.shipped.position.c2;
  options.progress(0.75);
  retuned.run = RunArm(options.run_stack, "fig10-retuned", ShippedStackText("retuned"), model, kFigure10Step);
  retuned.ratio = SettlingTime(retuned.run) / retuned.shortest;
  RunSteps(model, options, &retuned);
  return retuned;
}

}  // namespace

ArmRun RunArm(const StackRunner& run_stack, const std::string& name, const std::string& config,
              const model::ModelDescription& model, double step) {
  const tables::Table table = run_stack({name, config, settings::FormatModel(model)});
  const auto column = [&](const char* which) -> const std::vector<double>& {
    return table.Find(which)->values;
  };
  const std::vector<double>& reference = column("arm_ref_rad");
  const auto first =
      static_cast<size_t>(std::find(reference.begin(), reference.end(), step) - reference.begin());
  if (first == reference.size()) throw std::runtime_error(name + ": the reference never steps");
  ArmRun run;
  const std::vector<double>& times = column("time_s");
  const double limit = model.parameters.T_pmax * (1 - 1e-9);
  for (size_t i = first; i < times.size(); ++i) {
    run.time.push_back(times[i] - times[first]);
    run.angle.push_back(column("arm_angle_rad")[i]);
    const double voltage = column("voltage_V")[i];
    run.torque.push_back(model.parameters.k_1 * voltage);
    run.speed.push_back(column("motor_speed_rad_s")[i]);
    run.highest_speed = std::max(run.highest_speed, std::fabs(run.speed.back()));
    if (i + 1 < times.size() && std::fabs(run.torque.back()) >= limit)
      run.saturated_time += times[i + 1] - times[i];
  }
  run.response = runs::MeasureStep(run.time, run.angle, 0, run.time.size(), 0, step);
  return run;
}

const std::array<Cause, kCauseCount> kCauses = {{
    {"all_on", "full model", true, true, true, true},
    {"no_friction", "without Coulomb friction", false, true, true, true},
    {"no_saturation", "without the torque limit", true, false, true, true},
    {"no_friction_no_saturation", "without friction and torque limit", false, false, true, true},
    {"arm_speed_feedforward", "with arm-speed feed-forward", true, true, false, true},
    {"feedforward_no_friction_no_saturation", "feed-forward, no friction, no limit", false, false, false,
     true},
    {"no_arm_flow", "no friction, no limit, no flow from the arm's motion", false, false, true, false},
}};

Figure10Runs RunFigure10(const ExperimentOptions& options) {
  Figure10Runs figure;
  figure.model = ShippedModel("table1");
  figure.design = design::Figure8Model(figure.model.parameters);
  figure.c1 = figure.design.zero * kPaperGain;
  figure.c2 = kPaperGain;
  figure.forms = {RunForm(figure, design::DerivativeForm::kError, options.run_stack),
                  RunForm(figure, design::DerivativeForm::kMeasurement, options.run_stack)};
  const std::vector<double>& on_error = figure.forms[0].nonlinear.angle;
  for (size_t i = 0; i < on_error.size(); ++i) {
    figure.form_difference =
        std::max(figure.form_difference, std::fabs(on_error[i] - figure.forms[1].nonlinear.angle[i]));
  }
  options.progress(0.3);
  figure.causes = RunCauses(figure, options);
  figure.retuned = RunRetuned(figure.model, options);
  options.progress(0.95);
  return figure;
}

}  // namespace hydro::experiments
