#include "experiments/studies/uncertain_steps.h"

#include <algorithm>
#include <limits>

#include "base/parallel.h"
#include "base/units.h"
#include "experiments/runs/shipped_models.h"
#include "experiments/runs/shipped_stacks.h"
#include "experiments/studies/retuning.h"
#include "model/terms/drawn_model.h"
#include "runs/step_response.h"
#include "tune/design/bang_bang.h"

namespace hydro::experiments {
namespace {

constexpr double kMotorSpeed = 6000 * kRpm;  // rad/s, of the paper's motor
constexpr size_t kParts = 50;                // of the work, between reports of progress

}  // namespace

tune::StepTrial RetunedTrial(double step, double duration) {
  tune::StepTrial trial = TrialOf(ShippedStackText("retuned"), ShippedModelText("table1"), step);
  trial.duration = duration;
  return trial;
}

UncertainStep StepOf(tune::StepTrial trial, const model::ModelDescription& machine) {
  trial.model = machine;
  const tune::StepRun run = tune::RunStepTrial(trial);
  const design::Response& response = run.response;
  const runs::StepResponse measured =
      runs::MeasureStep(response.time, response.angle, 0, response.time.size(), 0, trial.step);
  UncertainStep step;
  step.parameters = machine.parameters;
  step.shortest = design::FastestSettling(design::MakeRigidDrive(machine.parameters, kMotorSpeed), trial.step,
                                          runs::kSettlingBand);
  step.settling = measured.settling_time_s.value_or(std::numeric_limits<double>::quiet_NaN());
  step.overshoot_percent = measured.overshoot_percent;
  step.final_error = measured.final_error_rad;
  step.saturated = run.saturated;
  step.highest_pressure = run.highest_pressure;
  step.highest_speed = run.highest_speed;
  return step;
}

UncertainSteps StepDrawnModels(const tune::StepTrial& trial, int count, uint64_t seed, int jobs,
                               const std::function<void(double)>& progress) {
  UncertainSteps steps;
  steps.trial = trial;
  steps.seed = seed;
  steps.known = StepOf(trial, trial.model);
  steps.drawn.resize(static_cast<size_t>(count));
  const size_t part = steps.drawn.size() / kParts + 1;
  for (size_t begin = 0; begin < steps.drawn.size(); begin += part) {
    ParallelFor(std::min(part, steps.drawn.size() - begin), jobs, [&](size_t i) {
      steps.drawn[begin + i] = StepOf(trial, model::DrawnModel(trial.model, seed, begin + i));
    });
    progress(static_cast<double>(std::min(begin + part, steps.drawn.size())) /
             static_cast<double>(steps.drawn.size()));
  }
  return steps;
}

}  // namespace hydro::experiments
