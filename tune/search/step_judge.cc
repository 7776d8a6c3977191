#include "tune/search/step_judge.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "model/sides.h"
#include "model/terms/description.h"
#include "model/terms/model_error.h"
#include "model/terms/parameter_info.h"
#include "plant/simulated_rig.h"
#include "runs/step_response.h"
#include "tune/design/bang_bang.h"
#include "tune/design/configured_laws.h"
#include "tune/design/operating_cases.h"

namespace hydro::tune {
namespace {

constexpr double kAim = 1.08;
constexpr double kUrge = 5;
// Gains with which fewer cases never settle are better, whatever the largest ratio is.
constexpr double kUnsettled = 10;
constexpr double kUsedTravel = 0.9;  // of the arm's range; steps start there, towards the middle
constexpr int64_t kSampleSeed = 20261123;
constexpr double kMostDeviations = 2;  // of a parameter in a sample

// rad: 0.05 to 0.3 for the paper's actuator, whose sides are empty at 0.858 rad.
constexpr double kStepShares[] = {0.05, 0.07, 0.1, 0.14, 0.2, 0.3};
constexpr double kPaperTravel = 0.8578;

std::vector<double> StepsFor(const settings::StackConfig& config, const Goals& goals) {
  if (goals.step) return {0.8 * *goals.step, *goals.step, 1.25 * *goals.step};
  const double travel = model::TravelOf(config.model.description).nearer();
  // Actuators with about the paper's travel use the same numbers.
  const double scale = std::fabs(travel / kPaperTravel - 1) < 0.5 ? 1 : travel / kPaperTravel;
  std::vector<double> steps;
  for (const double share : kStepShares) steps.push_back(share * scale);
  return steps;
}

// A sample of what may be true instead of the model. This is not model::DrawnModel, because these few samples
// have to be the same every time, none may be so rare that it alone would decide, and docs/tuning_gains.md
// states the gains found with them.
model::ModelDescription SampleOf(model::ModelDescription model, int sample) {
  for (size_t i = 0; i < model::BaseParameters().size(); ++i) {
    const double deviations = plant::StandardNormal(kSampleSeed, sample, static_cast<int>(i));
    model::Deviate(&model, i, std::clamp(deviations, -kMostDeviations, kMostDeviations));
  }
  return model;
}

settings::NoiseSection UsualNoise(const settings::StackConfig& config) {
  settings::NoiseSection noise = config.noise;
  const bool given =
      noise.p1_psi + noise.p2_psi + noise.motor_speed_rad_s + noise.arm_angle_rad + noise.arm_speed_rad_s > 0;
  if (given) return noise;
  const model::Parameters& p = config.model.description.parameters;
  noise.p1_psi = noise.p2_psi = 2e-4 * p.T_pmax / p.D;  // 1 psi on the paper's rig
  noise.motor_speed_rad_s = 0.1;
  noise.arm_angle_rad = 2.3e-5 * p.V_ms / p.c;  // 2e-5 rad there
  noise.arm_speed_rad_s = 10 * noise.arm_angle_rad;
  return noise;
}

// The arm's largest distance from where it should rest, at the end of a trial.
double LargestAtEnd(const std::vector<double>& angles, double rest) {
  const auto from = static_cast<size_t>((1 - kLastPart) * static_cast<double>(angles.size()));
  double largest = 0;
  for (size_t i = from; i < angles.size(); ++i) largest = std::max(largest, std::fabs(angles[i] - rest));
  return largest;
}

double LargestMotorSpeed(const settings::StackConfig& config) { return config.limits.motor_speed_rad_s; }

}  // namespace

// Below kAim, the shortest time with the model as its file says counts as nearly reached. What counts then is
// how little is lost where the model is not quite true.
double StepVerdict::score() const {
  return 0.5 * (ratio + uncertain_ratio) + kUrge * std::max(0.0, ratio - kAim) +
         kUnsettled * (unsettled + 0.5 * uncertain_unsettled);
}

StepJudge::StepJudge(settings::StackConfig config, const JudgeSettings& settings)
    : config_(std::move(config)), steps_(StepsFor(config_, settings.goals)) {
  goal_step_ = settings.goals.step.value_or(steps_[2]);
  config_.noise = settings.noise ? UsualNoise(config_) : settings::NoiseSection();
  models_.push_back(config_.model.description);
  for (int i = 1; i <= settings.samples; ++i) models_.push_back(SampleOf(config_.model.description, i));
  AddCases();
}

void StepJudge::AddCases() {
  const double end = kUsedTravel * design::LargestArmAngle(config_);
  const auto add = [&](size_t model, double start, double step) {
    const design::RigidDrive drive =
        design::MakeRigidDrive(models_[model].parameters, LargestMotorSpeed(config_));
    cases_.push_back(
        {model, start, step, design::FastestSettling(drive, std::fabs(step), runs::kSettlingBand)});
  };
  for (const double step : steps_) {
    const double last = std::max(end, step);
    add(0, 0, step);
    add(0, last - step, step);
    add(0, last, -step);
  }
  for (size_t model = 1; model < models_.size(); ++model) {
    for (const double step : {steps_.front(), steps_[steps_.size() / 2], steps_.back()}) add(model, 0, step);
  }
}

StepCase StepJudge::Nominal(double step) const {
  const design::RigidDrive drive =
      design::MakeRigidDrive(models_.front().parameters, LargestMotorSpeed(config_));
  return {0, 0, step, design::FastestSettling(drive, std::fabs(step), runs::kSettlingBand)};
}

StepTrial StepJudge::Trial(const Gains& gains, const StepCase& step) const {
  StepTrial trial = TrialOf(With(config_, gains));  // the gains follow from the model as its file says
  trial.model = models_[step.model];
  trial.noise = config_.noise;
  trial.seed = config_.seed;
  trial.start = step.start;
  trial.step = step.step;
  trial.duration = kNeverSettled * step.shortest;
  if (config_.model.description.parameters.mgl != 0) {
    // The arm first comes to rest where it hangs.
    const double sample = trial.tick * trial.interval;
    trial.rest = std::ceil(1.5 / sample) * sample;
  }
  return trial;
}

StepResult StepJudge::Try(const Gains& gains, const StepCase& step, StepRun* kept) const {
  const StepTrial trial = Trial(gains, step);
  StepRun run;
  try {
    run = RunStepTrial(trial);
  } catch (const model::ModelError&) {  // the arm ran into its stop
    return {.ratio = kNeverSettled + kStopped};
  }
  const design::Response& response = run.response;
  // With a weight the arm hangs below its reference, so the position at which it settles is its own end
  // value.
  const double from = response.angle.front();
  double to = step.step;
  if (models_[step.model].parameters.mgl != 0) {
    to = runs::MeasureStep(response.time, response.angle, 0, response.time.size(), from, step.step)
             .final_error_rad +
         step.step;
  }
  const runs::StepResponse measured =
      runs::MeasureStep(response.time, response.angle, 0, response.time.size(), from, to);
  StepResult result;
  result.settled = measured.settling_time_s.has_value();
  result.settling = measured.settling_time_s.value_or(trial.duration);
  result.overshoot_percent = measured.overshoot_percent;
  result.error = response.angle.back() - step.step;
  result.saturated = run.saturated;
  result.ratio = result.settled
                     ? result.settling / step.shortest
                     : kNeverSettled + std::min(1.0, LargestAtEnd(response.angle, to) / std::fabs(step.step));
  const bool stops = run.highest_pressure > config_.limits.pressure_psi ||
                     run.highest_speed > config_.limits.motor_speed_rad_s;
  if (step.model == 0 && stops) result.ratio += kStopped;
  if (kept != nullptr) *kept = std::move(run);
  return result;
}

StepVerdict StepJudge::Judge(const Gains& gains) const {
  StepVerdict verdict;
  double cases = 0, samples = 0;
  for (const StepCase& step : cases_) {
    const StepResult result = Try(gains, step);
    (step.model == 0 ? cases : samples) += 1;
    if (!result.settled) (step.model == 0 ? verdict.unsettled : verdict.uncertain_unsettled) += 1;
    double& ratio = step.model == 0 ? verdict.ratio : verdict.uncertain_ratio;
    if (result.ratio > ratio) (step.model == 0 ? verdict.slowest : verdict.uncertain_slowest) = step;
    ratio = std::max(ratio, result.ratio);
    if (step.model == 0) {
      verdict.overshoot_percent = std::max(verdict.overshoot_percent, result.overshoot_percent);
      if (std::fabs(step.step) == goal_step_) verdict.settling = std::max(verdict.settling, result.settling);
    }
  }
  verdict.unsettled /= cases;
  if (samples > 0) verdict.uncertain_unsettled /= samples;
  verdict.uncertain_ratio = std::max(verdict.uncertain_ratio, verdict.ratio);
  return verdict;
}

}  // namespace hydro::tune
